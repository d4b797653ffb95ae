#pragma once

// The heavy top of Bruels & Cardona 2010: a rigid body whose tip is fixed at the origin, in uniform gravity.
// Data and frames: HeavyTopParameters. Its formulations, each a class template on the scalar:
//
//   HeavyTopSO3, HeavyTopS3                   rotation about the tip, without constraints   heavy_top_fixed.h
//   HeavyTopR3xSO3, HeavyTopR3xS3             free body, velocity in the inertial frame     heavy_top_free.h
//   HeavyTopSE3, HeavyTopS3R3, HeavyTopUDQ    free body, velocity in the body frame         heavy_top_moving.h
//
// One motion in all of them: configuration, velocity, acceleration and multipliers give its state in each. lambda
// is the same force, that on the body at its tip, in the body frame.

#include "problems/heavy_top_fixed.h"
#include "problems/heavy_top_free.h"
#include "problems/heavy_top_moving.h"
