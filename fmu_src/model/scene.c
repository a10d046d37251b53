#include "model/scene.h"

#include <math.h>

FcScene fc_scene_make(const FcContactParameters* contact, const FcDrive* drive, double F_C) {
    return (FcScene){.contact = contact,
                     .at_E = fc_contact_at_modulus(contact, drive->E.value),
                     .drive = *drive,
                     .F_C = F_C};
}

// The contact at the modulus of the time t.
static FcContactAtModulus contact_at(const FcScene* scene, double t) {
    const FcDrive* drive = &scene->drive;
    return drive->E.rate == 0.0 ? scene->at_E : fc_contact_at_modulus(scene->contact, fc_drive_E(drive, t));
}

FcContactResponse fc_scene_contact(const FcScene* scene, double t) {
    const FcContactAtModulus at_E = contact_at(scene, t);
    return fc_contact_response(&at_E, fc_drive_d(&scene->drive, t));
}

FcCoefficients fc_scene_coefficients(const FcScene* scene, double t) {
    const FcDriveValues now = fc_drive_values(&scene->drive, t);
    if (scene->at_E.constant) {
        return (FcCoefficients){.V = now.V, .sigma = scene->at_E.stiffness_0, .limit = scene->F_C};
    }
    if (scene->drive.E.rate == 0.0) {
        return (FcCoefficients){
            .V = now.V, .sigma = fc_contact_stiffness(&scene->at_E, now.d), .limit = scene->F_C};
    }
    const FcContactAtModulus at_E = contact_at(scene, t);
    return (FcCoefficients){.V = now.V, .sigma = fc_contact_stiffness(&at_E, now.d), .limit = scene->F_C};
}

double fc_scene_stiffness(const FcScene* scene, double t) { return fc_scene_coefficients(scene, t).sigma; }

double fc_scene_log_stiffness_rate(const FcScene* scene, double t) {
    const FcDrive* drive = &scene->drive;
    const double d = fc_drive_d(drive, t);
    const double E = fc_drive_E(drive, t);
    const double sigma = fc_scene_stiffness(scene, t);
    const FcContactGradient slope = fc_contact_stiffness_gradient(scene->contact, d, E);
    return sigma > 0.0 ? (slope.by_d * fc_drive_d_rate(drive, t) + slope.by_E * drive->E.rate) / sigma : 0.0;
}

double fc_scene_largest_stiffness(const FcScene* scene, double h) {
    const FcDrive* drive = &scene->drive;
    if (drive->E.rate == 0.0) {
        return fc_contact_stiffness(&scene->at_E, fc_drive_smallest_d(drive, h));
    }
    const FcContactAtModulus stiffest = fc_contact_at_modulus(scene->contact, fc_drive_largest_E(drive, h));
    return fc_contact_stiffness(&stiffest, fc_drive_smallest_d(drive, h));
}
