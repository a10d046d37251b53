// Derivatives of the contact's stiffness, area and force at the start of a scene.
#ifndef FC_MODEL_DERIVATIVES_H
#define FC_MODEL_DERIVATIVES_H

#include "model/regime.h"

// Derivatives of ln(sigma), ln(A_r) and ln(F_n) along a direction. With a load they include the motion of the
// separation. Those of F_n and A_r are 0 for an open contact.
FcContactLogSlope fc_contact_along(const FcScene* scene, const FcDirection* along);

#endif
