// The bones of the head as distances, beside its brain (phantom_cranium.cpp). Patient mm; `m` is
// the point mirrored to the patient's left.
#pragma once

#include "volume/phantom_shapes.h"

namespace trephine::skull {

// The scan is 180 mm long, and so the face below the eye sockets is drawn lower than life: its
// figures are a life-size face's, and this is where they are looked up.
Vec3 lifeSize(const Vec3& m);

// Air spaces, eye sockets and canals within the bones. Negative inside.
double orbit(const Vec3& m);  // a rounded square of 40 x 35 mm in front, an apex behind
double nose(const Vec3& m);   // the pear-shaped opening and the cavity behind it
double earCanal(const Vec3& m);

// How far the vault's bone lies outside of its ellipsoid: eminences, the temporal fossa below its
// line, the protuberance of the occiput. Slopes under 0.3, so that layers keep their thickness.
double relief(const Vec3& m);
// Depth of the sutures' groove in the outer table.
double suture(const Vec3& m);

// Face, base and jaw without the vault's own shell: `braincase` is the distance to the outside of
// vault and base. Negative inside.
double bones(const Vec3& m, double braincase);

// Vertebrae of the neck, without what runs in their canal. Negative inside.
double vertebrae(const Vec3& m, double canal);

// Skin of face, ears and neck, joined to the scalp, whose distance is `scalp`.
double skin(const Vec3& m, double scalp);

}  // namespace trephine::skull
