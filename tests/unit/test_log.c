// What the log sends: units, and decimal points whatever the host's locale. tests/fmi2/test_log.py has the rest.
#include "fmi2/log.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static char sent[2048];

static void keep(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                 fmi2String category, fmi2String text, ...) {
    (void)environment, (void)name, (void)status, (void)category;
    snprintf(sent, sizeof sent, "%s", text);
}

static const fmi2CallbackFunctions callbacks = {keep, calloc, free, NULL, NULL};

static void check_sends(const char* text, const char* expected) {
    char whole[2048];
    snprintf(whole, sizeof whole, "fmi2Instantiate: %s", expected);
    fc_log_refused_instance(&callbacks, "unit", "%s", text);
    if (strcmp(sent, whole) != 0) {
        fprintf(stderr, "sent: %s\nexpected: %s\n", sent, whole);
    }
    CHECK(strcmp(sent, whole) == 0);
}

static void quantities_carry_their_unit(void) {
    CHECK(strcmp(fc_quantity_text(14e-6, "m").text, "1.4e-05 m") == 0);
    CHECK(strcmp(fc_quantity_text(0.1, "1").text, "0.1") == 0);
    CHECK(strcmp(fc_quantity_text(2.0, "").text, "2") == 0);
    CHECK(strcmp(fc_quantity_text(1.0 / 3.0, "N").text, "0.333333333333333 N") == 0);
}

// A comma between digits is the decimal point's; one that ends a clause, or stands between words, is not.
static void commas_between_digits_become_points(void) {
    check_sends("d = 1,5 m, at least 0 m", "d = 1.5 m, at least 0 m");
    check_sends("0,25 1,5e-06 -3,0,", "0.25 1.5e-06 -3.0,");
    check_sends(",5 a,b 1,", ",5 a,b 1,");
    check_sends("", "");
    char text[64];
    snprintf(text, sizeof text, "%.3f", 0.125);
    CHECK(strcmp(text, "0,125") == 0); // the locale is what this test is about
    check_sends(text, "0.125");
}

int main(void) {
    quantities_carry_their_unit();
    check_sends("1,5 stays", "1,5 stays");
    const int result = check_result();
    if (result == 0 && !setlocale(LC_NUMERIC, "de_DE.UTF-8")) {
        fprintf(stderr, "skipped: no locale with a decimal comma\n");
        return 77;
    }
    commas_between_digits_become_points();
    return check_result();
}
