#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

#include "integrators/fits.h"
#include "integrators/inlining.h"
#include "integrators/mass_solver.h"
#include "integrators/option.h"
#include "integrators/outcome.h"
#include "integrators/runge_kutta_munthe_kaas.h"
#include "integrators/runge_kutta_tableau.h"
#include "integrators/starting_values.h"
#include "integrators/step_control.h"

namespace liebench {
