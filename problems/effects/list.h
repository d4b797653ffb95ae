#pragma once

#include <tuple>
#include <vector>

#include "problems/effects/spring_damper.h"
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
using SceneEffects = EffectLists<T, UniformGravity, SpringDamper>;

}  // namespace liebench
