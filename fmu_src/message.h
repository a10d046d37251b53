// A short text that says what went wrong: which variable, its value, its bound.
// Filled by the function that fails; untouched on success.
#ifndef FC_MESSAGE_H
#define FC_MESSAGE_H

typedef struct {
    char text[320];
} Message;

#endif
