#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/bliedf2nd.h"
#include "integrators/explicit_stepper.h"
#include "integrators/implicit_midpoint.h"
#include "integrators/rkmk.h"
#include "tests/support/method_laws.h"

// Wrong methods, planted: the laws of every method (tests/support/broken_law.h) name what is wrong with each of them, and nothing else.
// Beside each stands the right one, which breaks none.

namespace liebench::wrong_methods_test {
namespace {

using SO3Top = HeavyTopSO3<Extended>;
using R3xSO3Top = HeavyTopR3xSO3<Extended>;

template <class Method, MechanicalSystem S>
MethodCase<S> planted(const OptionValues& values) {
  return method_case<Method, S>(values, [options = Method::options(values)](const S& system) {
    return held_stepper<Method, S>(options, system);
  });
}

template <MechanicalSystem S>
void expect_broken(const MethodCase<S>& method, const std::set<std::string_view>& expected,
                   const std::string& measured = "") {
  std::set<std::string_view> broken;
  std::string texts;
  for (const BrokenLaw& each : broken_laws(method)) {
    broken.insert(each.law.name);
    texts += text(method.text(), each) + "\n";
  }
  EXPECT_EQ(broken, expected) << method.text() << "\n" << texts;
  EXPECT_THAT(texts, ::testing::HasSubstr(measured));
}

// --- BLieDF2nd -------------------------------------------------------------------------------------------

// kappa = h^2 L_3 where it is -h^2 L_3.
template <MechanicalSystem S>
class CorrectionOfTheWrongSign {
 public:
  using T = typename S::Scalar;
  CorrectionOfTheWrongSign(const S& system, const BLieDF2nd::Options&) : group_(group_of(system)) {}
  void start(std::span<const Configuration<S>>) {}
  bool defined(const BdfState<S>&) const { return true; }
  void accept(const Configuration<S>&) {}
  AffineClosure<S> closure(const BdfState<S>& state, AffineClosure<S> affine) const {
    const Velocity<S> a = T(1.5) * state.velocity_changes[0] - T(0.5) * state.velocity_changes[1];
    const Velocity<S> change = leading_correction(group_, state.h, state.velocity, a) - state.kappa;
    affine.velocity_change += change;
    affine.scaled_acceleration += affine.velocity_slope * change;
    return affine;
  }

 private:
  typename S::Group group_;
};

struct WrongSignOfL : BLieDF2nd {
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return visit(BdfStepper<S, Form::index3, Audit, CorrectionOfTheWrongSign<S>>(system, options));
  }
};

OptionValues bliedf2nd_options(std::string_view form = "") {
  OptionValues values;
  values.set("k", 3);
  values.set("correction", true);
  if (!form.empty()) values.set("form", std::string(form));
  return values;
}

TEST(WrongMethod, BLieDF2ndWithTheOppositeSignOfItsCorrectionHasNotItsOrder) {
  expect_broken(planted<BLieDF2nd, SO3Top>(bliedf2nd_options()), {});
  expect_broken(planted<WrongSignOfL, SO3Top>(bliedf2nd_options()), {"order"}, "order 1.99 of q");
}

// The whole message, as docs/adding-an-integrator.md prints it. LIEBENCH_UPDATE_GOLDEN=1 writes it anew.
TEST(WrongMethod, IsToldWhichLawItBreaksInWords) {
  const MethodCase<SO3Top> method = planted<WrongSignOfL, SO3Top>(bliedf2nd_options());
  const std::vector<BrokenLaw> broken = broken_laws(method);
  ASSERT_EQ(broken.size(), 1u);
  const std::string message = text(method.text(), broken[0]) + "\n";
  const std::filesystem::path file = std::filesystem::path(__FILE__).parent_path() / "wrong_sign.txt";
  if (std::getenv("LIEBENCH_UPDATE_GOLDEN") != nullptr) std::ofstream(file) << message;
  std::ifstream stream(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), message);
}

// "form": "stabilized_index2" read, and forgotten.
struct WithoutTheHiddenConstraint : BLieDF2nd {
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options& options, const S& system, Visitor&& visit) {
    return visit(Stepper<S, Form::index3, Audit>(system, options));
  }
};

TEST(WrongMethod, AStabilizedOneThatForgetsTheHiddenConstraintBreaksIt) {
  const OptionValues values = bliedf2nd_options("stabilized_index2");
  expect_broken(planted<BLieDF2nd, R3xSO3Top>(values), {});
  expect_broken(planted<WithoutTheHiddenConstraint, R3xSO3Top>(values), {"constraints"}, "|B(q) v| = ");
}

// --- tangent operators -----------------------------------------------------------------------------------

template <class G>
struct TangentForItsInverse : G {
  static typename G::Tangent tangent_inverse_times(const typename G::Tangent& v,
                                                   const typename G::Tangent& w) {
    return G::tangent_times(v, w);
  }
};
template <class G>
struct TangentInverseOfTheOppositeArgument : G {
  static typename G::Tangent tangent_inverse_times(const typename G::Tangent& v,
                                                   const typename G::Tangent& w) {
    return G::tangent_inverse_times(-v, w);
  }
};

// A system on the same group with a wrong operator.
template <MechanicalSystem S, template <class> class Wrong>
struct OnWrongGroup : S {
  using Group = Wrong<typename S::Group>;
  explicit OnWrongGroup(const S& system) : S(system) {}
};

template <template <class> class Wrong>
struct WrongRkmk : Rkmk {
  struct Scheme {
    template <MechanicalSystem S, class Acceleration>
    static StepResult step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                           Configuration<S>& q, Velocity<S>& v, const Acceleration& acceleration) {
      return runge_kutta_munthe_kaas_step<classical_four>(OnWrongGroup<S, Wrong>(system), t, h, q, v,
                                                          acceleration);
    }
  };
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(ExplicitStepper<S, Audit, Scheme>(system));
  }
};

TEST(WrongMethod, ARungeKuttaMuntheKaasMethodWithAWrongTangentOperatorHasNotItsOrder) {
  OptionValues values;
  values.set("tableau", std::string("rk4"));
  expect_broken(planted<Rkmk, SO3Top>(values), {});
  expect_broken(planted<WrongRkmk<TangentForItsInverse>, SO3Top>(values), {"order"}, "order 2.0");
  expect_broken(planted<WrongRkmk<TangentInverseOfTheOppositeArgument>, SO3Top>(values), {"order"},
                "order 2.0");
}

// --- the explicit midpoint rule, with one mistake at a time ----------------------------------------------

struct NoMistake {
  static constexpr bool declared_symmetric = false;
  template <MechanicalSystem S>
  static Configuration<S> moved(const S& system, const Configuration<S>& q, const Velocity<S>& theta) {
    return group_of(system).compose(q, group_of(system).exp(theta));
  }
  template <MechanicalSystem S>
  static Outcome outcome_of(const S& system, const Velocity<S>& theta) {
    return outcome_of_turn(system, theta);
  }
  template <class Vector>
  static void look_at(Vector&) {}
};

template <class Mistake>
struct Midpoint {
  static constexpr std::string_view name = "explicit_midpoint";
  static constexpr std::string_view summary = "explicit midpoint rule, order 2";
  static constexpr Fits fits = Fits::without_constraints;
  static constexpr std::array<OptionInfo, 0> option_list{};
  static std::string title(const OptionValues&) { return "explicit midpoint"; }
  static ConvergenceOrders orders(const OptionValues&) { return same_order(2); }
  static bool symmetric(const OptionValues&) { return Mistake::declared_symmetric; }
  struct Options {};
  static Options options(const OptionValues&) { return {}; }

  struct Scheme {
    template <MechanicalSystem S, class Acceleration>
    static StepResult step(const S& system, const typename S::Scalar& t, const typename S::Scalar& h,
                           Configuration<S>& q, Velocity<S>& v, const Acceleration& acceleration) {
      using T = typename S::Scalar;
      Velocity<S> F;
      if (const Outcome outcome = acceleration(t, q, v, F); outcome != Outcome::ok) return {outcome};
      Mistake::look_at(F);
      const T half = h / T(2.0);
      const Velocity<S> w = v + half * F, theta = h * w, first = half * v;
      if (const Outcome outcome = Mistake::outcome_of(system, theta); outcome != Outcome::ok)
        return {outcome};
      if (const Outcome outcome = acceleration(T(t + half), Mistake::moved(system, q, first), w, F);
          outcome != Outcome::ok)
        return {outcome};
      Mistake::look_at(F);
      q = Mistake::moved(system, q, theta);
      v += h * F;
      return {};
    }
  };
  template <MechanicalSystem S, class Audit, class Visitor>
  static auto with_stepper(const Options&, const S& system, Visitor&& visit) {
    return visit(ExplicitStepper<S, Audit, Scheme>(system));
  }
};

TEST(WrongMethod, TheMidpointRuleBreaksNoLaw) {
  expect_broken(planted<Midpoint<NoMistake>, SO3Top>({}), {});
}

// Velocities of the body, as if they were those of the inertial frame. (The hanging top turns about one axis: no product is wrong there.)
struct IncrementsOnTheLeft : NoMistake {
  template <MechanicalSystem S>
  static Configuration<S> moved(const S& system, const Configuration<S>& q, const Velocity<S>& theta) {
    return group_of(system).compose(group_of(system).exp(theta), q);
  }
};

TEST(WrongMethod, IncrementsOnTheLeftDependOnTheInertialFrame) {
  expect_broken(planted<Midpoint<IncrementsOnTheLeft>, SO3Top>({}), {"inertial frame", "order"});
}

// Cayley's map turns by 2 arctan(|theta| / 2): order 2 is not lost, only that a constant velocity is integrated exactly.
struct CayleyForExp : NoMistake {
  template <MechanicalSystem S>
  static Configuration<S> moved(const S& system, const Configuration<S>& q, const Velocity<S>& theta) {
    using T = typename S::Scalar;
    using std::atan;
    const T angle = theta.norm();
    const T factor = T(0.0) < angle ? T(T(2.0) * atan(T(angle / T(2.0))) / angle) : T(1.0);
    return NoMistake::moved<S>(system, q, Velocity<S>(factor * theta));
  }
};

TEST(WrongMethod, CayleysMapDoesNotFollowAConstantVelocity) {
  expect_broken(planted<Midpoint<CayleyForExp>, SO3Top>({}), {"constant velocity"});
}

struct NoLimitOfTurn : NoMistake {
  template <MechanicalSystem S>
  static Outcome outcome_of(const S&, const Velocity<S>&) {
    return Outcome::ok;
  }
};

TEST(WrongMethod, AStepThatNobodyAsksForItsAngleTurnsTooFar) {
  expect_broken(planted<Midpoint<NoLimitOfTurn>, SO3Top>({}), {"large rotation"}, "measured: ok");
}

struct IgnoresWhatIsNoNumber : NoMistake {
  template <class Vector>
  static void look_at(Vector& F) {
    if (!std::isfinite(to_double(F.squaredNorm()))) F.setConstant(typename Vector::Scalar(0.0));
  }
};

TEST(WrongMethod, ForcesThatAreNoNumbersAreNotLeftOut) {
  expect_broken(planted<Midpoint<IgnoresWhatIsNoNumber>, SO3Top>({}), {"no number"}, "measured: ok");
}

struct CallsItselfSymmetric : NoMistake {
  static constexpr bool declared_symmetric = true;
};
struct DoesNotSayThatItIsSymmetric : ImplicitMidpoint {
  static bool symmetric(const OptionValues&) { return false; }
};

TEST(WrongMethod, WhatIsSymmetricSaysSoAndWhatIsNotDoesNot) {
  expect_broken(planted<Midpoint<CallsItselfSymmetric>, SO3Top>({}), {"time reversal"});
  OptionValues values;
  values.set("safeguard", false);
  expect_broken(planted<ImplicitMidpoint, SO3Top>(values), {});
  expect_broken(planted<DoesNotSayThatItIsSymmetric, SO3Top>(values), {"time reversal"});
}

}  // namespace
}  // namespace liebench::wrong_methods_test
