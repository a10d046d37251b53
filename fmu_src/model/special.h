// The special functions of the contact's averages over the asperity heights and over the vibration.
#ifndef FC_MODEL_SPECIAL_H
#define FC_MODEL_SPECIAL_H

// Incomplete gamma functions for x >= 0, to a few roundings: lower, integral of t^(a-1) e^-t over [0, x], for
// a = 3/2 and 5/2; upper, the integral over [x, infinity), for a = 3/2.
double fc_lower_gamma_3_2(double x);
double fc_lower_gamma_5_2(double x);
double fc_upper_gamma_3_2(double x);

// ln I_0(x) of the modified Bessel function for x >= 0: ln of the mean of e^(x cos) over a period.
double fc_log_bessel_I0(double x);

// Its derivative I_1(x) / I_0(x).
double fc_bessel_ratio(double x);

#endif
