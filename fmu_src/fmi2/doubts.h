// Start values that were hardly meant: settings that the scene does not use, and magnitudes that look like another unit. Each is told
// once in the log, as a warning, when initialization ends.
#ifndef FC_FMI2_DOUBTS_H
#define FC_FMI2_DOUBTS_H

#include "fmi2/instance.h"

void fc_log_doubts(const FcInstance* instance);

#endif
