// The contact of Table 1 of the paper, of any model.
#ifndef FC_UNIT_TABLE_1_H
#define FC_UNIT_TABLE_1_H

#include "model/contact.h"

static inline FcContactParameters table_1(int model, int input) {
    return (FcContactParameters){.model = model,
                                 .input = input,
                                 .sigma = 2.5e6,
                                 .stiffnessScale = 1.0,
                                 .R_q = 6e-6,
                                 .R = 1.7e-6,
                                 .eta = 47e9,
                                 .A_n = 1e-4,
                                 .nu = 0.33,
                                 .Y = 410e6,
                                 .c = 17.0,
                                 .lambda = 3.0};
}

#endif
