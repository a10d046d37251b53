// Mathematical constants that C11 does not promise, to all digits of a double: pi and 2 pi.
#ifndef FC_MODEL_PI_H
#define FC_MODEL_PI_H

#define FC_PI 3.14159265358979323846
#define FC_TWO_PI 6.28318530717958647693

#endif
