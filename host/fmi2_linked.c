#include "fmi2Functions.h"
#include "fmi2_library.h"

const Fmi2Library fmi2_linked = {
#define LINKED(name) .name = fmi2##name,
    FMI2_COMMON_FUNCTIONS(LINKED) FMI2_CO_SIMULATION_FUNCTIONS(LINKED) FMI2_MODEL_EXCHANGE_FUNCTIONS(LINKED)};
