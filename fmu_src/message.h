// A short text that names the fault: variable, value, bound. The function that fails fills it; success leaves
// it unchanged.
#ifndef FC_MESSAGE_H
#define FC_MESSAGE_H

#include <stdbool.h>

// Lets the compiler check the arguments by the format.
#if defined __GNUC__
#define FC_PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))
#else
#define FC_PRINTF_LIKE(text, first)
#endif

typedef struct {
    char text[320];
} FcMessage;

// Writes the text, cut off if it is too long. Returns false, so that a function that fails can return the
// call.
bool fc_message_set(FcMessage* message, const char* format, ...) FC_PRINTF_LIKE(2, 3);

#endif
