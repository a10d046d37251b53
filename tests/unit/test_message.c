// A message is cut off where it is too long, and setting one is how a function fails.
#include "message.h"

#include <string.h>

#include "check.h"

int main(void) {
    FcMessage message = {"untouched"};
    CHECK(!fc_message_set(&message, "d = %.9g m", 14e-6));
    CHECK(strcmp(message.text, "d = 1.4e-05 m") == 0);

    char longer[2 * sizeof message.text];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    CHECK(!fc_message_set(&message, "%s", longer));
    CHECK(strlen(message.text) == sizeof message.text - 1);
    CHECK(strspn(message.text, "x") == sizeof message.text - 1);
    return check_result();
}
