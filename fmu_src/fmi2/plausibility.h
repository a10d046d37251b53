// Start values that are probably mistakes: settings that the scene does not use, magnitudes that look like
// another unit, and a settled start of a contact that is nearly open. The log has one warning for each when
// initialization ends.
#ifndef FC_FMI2_PLAUSIBILITY_H
#define FC_FMI2_PLAUSIBILITY_H

#include "fmi2/instance.h"

void fc_log_plausibility(FcInstance* instance);

// Once: the settled state that the call has found is chaotic.
void fc_log_scatter(FcInstance* instance, FcCall call);

#endif
