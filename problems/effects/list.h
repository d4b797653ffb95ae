#pragma once

#include <tuple>
#include <vector>

#include "problems/effects/applied_force.h"
#include "problems/effects/bushing.h"
#include "problems/effects/contact.h"
#include "problems/effects/drag.h"
#include "problems/effects/joint_friction.h"
#include "problems/effects/motor.h"
#include "problems/effects/point_gravity.h"
#include "problems/effects/spring_damper.h"
#include "problems/effects/torsional_spring.h"
#include "problems/effects/uniform_gravity.h"

namespace liebench {

// An effect with the bodies that it acts on: indices, -1 for the ground.
template <class Effect>
struct Placed {
  Effect effect;
  int a, b;
};

// Every effect: the explicit list. What acts in a scene, sorted by its type, so that a loop over it has no dispatch.
template <class T, template <class> class... Effects>
using EffectLists = std::tuple<std::vector<Placed<Effects<T>>>...>;
template <class T>
using SceneEffects = EffectLists<T, UniformGravity, PointGravity, SpringDamper, TorsionalSpring, Bushing,
                                 Drag, AppliedForce, Motor, RevoluteFriction, PrismaticFriction, Contact>;

}  // namespace liebench
