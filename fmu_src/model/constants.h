// Mathematical constants that C11 does not promise, to all digits of a double: pi, 2 pi, Euler's constant.
#ifndef FC_MODEL_CONSTANTS_H
#define FC_MODEL_CONSTANTS_H

#define FC_PI 3.14159265358979323846
#define FC_TWO_PI 6.28318530717958647693
#define FC_EULER_GAMMA 0.57721566490153286061

#endif
