#include "problems/system_check.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "problems/check_system.h"
#include "problems/heavy_top_free.h"
#include "problems/linear_oscillator.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/small_systems.h"

namespace liebench::system_check_test {
namespace {

enum class Mistake {
  none,
  other_scalar,
  not_in_group,
  unsymmetric_mass,
  indefinite_mass,
  variable_mass,
  coupled_blocks,
  momentum,
  gradient_sign,
  product,
  force_of_constraint,
  rate,
  coriolis,
  gradient_derivative,
  damping,
  stiffness,
  kinetic_energy,
  potential_sign,
  open_joint,
  velocity,
  not_a_number,
};

// The heavy top with a mistake of its author, the same in every scalar.
template <class T>
class MistakenTop : public HeavyTopR3xSO3<T> {
 public:
  using Base = HeavyTopR3xSO3<T>;
  using typename Base::Element;
  using typename Base::Gradient;
  using typename Base::Matrix6;
  using typename Base::Vector;
  using typename Base::Vector6;
  template <class U>
  using rebind = MistakenTop<U>;

  MistakenTop(const HeavyTopParameters& parameters, Mistake mistake)
      : Base(parameters), parameters_(parameters), mistake_(mistake) {}
  template <class U>
  MistakenTop<U> cast() const {
    HeavyTopParameters p = parameters_;
    if (mistake_ == Mistake::other_scalar) p.mass += 1e-9;
    return {p, mistake_};
  }

  Matrix6 mass_matrix(const Element& q) const {
    Matrix6 M = Base::mass_matrix(q);
    if (mistake_ == Mistake::unsymmetric_mass) M(1, 0) += T(1e-6);
    if (mistake_ == Mistake::indefinite_mass) M(3, 4) = M(4, 3) = T(1.0);
    if (mistake_ == Mistake::variable_mass) M(2, 2) += q.first(0) * 1e-3;
    if (mistake_ == Mistake::coupled_blocks) M(4, 1) = M(1, 4) = T(1e-9);
    return M;
  }
  Vector6 momentum(const Element& q, const Vector6& w) const {
    Vector6 p = mass_matrix(q) * w;
    if (mistake_ == Mistake::momentum) p(5) += w(3) * 1e-9;
    return p;
  }
  Vector6 force(const T& t, const Element& q, const Vector6& v) const {
    Vector6 g = Base::force(t, q, v);
    // Beside the initial values only.
    const T moved = q.first(1) - Base::initial_configuration().first(1);
    if (mistake_ == Mistake::not_a_number && T(1e-6) < moved * moved) g(2) = T(std::nan(""));
    return g;
  }
  Matrix6 damping(const T& t, const Element& q, const Vector6& v) const {
    Matrix6 C = Base::damping(t, q, v);
    if (mistake_ == Mistake::damping) C(3, 5) = -C(3, 5);
    return C;
  }
  Matrix6 stiffness(const T& t, const Element& q, const Vector6& v, const Vector6& a,
                    const Vector& lambda) const {
    Matrix6 K = Base::stiffness(t, q, v, a, lambda);
    if (mistake_ == Mistake::stiffness) K(0, 4) = -K(0, 4);
    return K;
  }
  T energy(const Element& q, const Vector6& v) const {
    const Vector6 rest = Vector6::Constant(T(0.0));
    const T potential = Base::energy(q, rest), kinetic = Base::energy(q, v) - potential;
    if (mistake_ == Mistake::kinetic_energy) return kinetic * 2.0 + potential;
    if (mistake_ == Mistake::potential_sign) return kinetic - potential;
    return kinetic + potential;
  }
  Vector constraint(const Element& q) const { return Base::constraint(q); }
  Gradient constraint_gradient(const Element& q) const {
    Gradient B = Base::constraint_gradient(q);
    if (mistake_ == Mistake::gradient_sign) B(1, 5) = -B(1, 5);
    return B;
  }
  Vector constraint_product(const Element& q, const Vector6& w) const {
    Vector p = constraint_gradient(q) * w;
    if (mistake_ == Mistake::product) p(2) += w(0) * 1e-6;
    return p;
  }
  Vector constraint_rate(const T&, const Element& q, const Vector6& v) const {
    Vector p = Base::constraint_gradient(q) * v;
    if (mistake_ == Mistake::rate) p(0) = -p(0);
    return p;
  }
  Vector6 constraint_force(const Element& q, const Vector& lambda) const {
    Vector6 f = Base::constraint_force(q, lambda);
    if (mistake_ == Mistake::force_of_constraint) f(3) = -f(3);
    return f;
  }
  Vector constraint_curvature(const Element& q, const Vector6& v) const {
    Vector Z = Base::constraint_curvature(q, v);
    // 2 Omega x R^T u without the 2.
    const Vector omega = v.template tail<3>(), u = v.template head<3>();
    if (mistake_ == Mistake::coriolis) Z -= omega.cross(Vector(q.second.transpose() * u));
    return Z;
  }
  Gradient constraint_gradient_derivative(const Element& q, const Vector6& v) const {
    Gradient Z = Base::constraint_gradient_derivative(q, v);
    if (mistake_ == Mistake::gradient_derivative) Z(2, 1) = -Z(2, 1);
    return Z;
  }
  Element initial_configuration() const {
    Element q = Base::initial_configuration();
    if (mistake_ == Mistake::open_joint) q.first(1) += T(1e-9);
    if (mistake_ == Mistake::not_in_group) q.second *= T(1.0 + 1e-9);
    return q;
  }
  Vector6 initial_velocity() const {
    Vector6 v = Base::initial_velocity();
    if (mistake_ == Mistake::velocity) v(0) += T(0.25);
    return v;
  }

 private:
  HeavyTopParameters parameters_;
  Mistake mistake_;
};

// The tip at the origin and the axes parallel to those of the ground, so that entries can be told by hand.
HeavyTopParameters upright() {
  HeavyTopParameters p = unsymmetric_top(1);
  p.orientation = {1.0, 0.0, 0.0, 0.0};
  return p;
}
SystemCheck check_of(Mistake mistake, const CheckOptions& options = {}) {
  return check_system(MistakenTop<double>(upright(), mistake), options);
}

struct Expectation {
  Mistake mistake;
  Law law;
  std::string row, column;
};
const std::vector<Expectation> expectations{
    {Mistake::unsymmetric_mass, Law::mass_symmetry, "v[1]", "v[0]"},
    {Mistake::variable_mass, Law::constant_mass, "v[2]", "v[2]"},
    {Mistake::momentum, Law::momentum, "v[5]", "v[3]"},
    {Mistake::gradient_sign, Law::constraint_gradient, "lambda[1]", "v[5]"},
    {Mistake::gradient_sign, Law::constraint_force, "lambda[1]", "v[5]"},
    {Mistake::product, Law::constraint_product, "lambda[2]", "v[0]"},
    {Mistake::rate, Law::constraint_rate, "lambda[0]", ""},
    {Mistake::gradient_derivative, Law::gradient_derivative, "lambda[2]", "v[1]"},
    {Mistake::damping, Law::damping, "v[3]", "v[5]"},
    {Mistake::stiffness, Law::stiffness, "v[0]", "v[4]"},
    {Mistake::velocity, Law::velocity_constraint, "lambda[0]", ""},
    {Mistake::open_joint, Law::position_constraint, "lambda[1]", ""},
    {Mistake::not_in_group, Law::group, "", ""},
};

TEST(SystemCheck, ARightSystemKeepsEveryLaw) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const SystemCheck check = check_system(MistakenTop<double>(p, Mistake::none));
    EXPECT_TRUE(check.extended);
    EXPECT_EQ(check.points, 5);
    EXPECT_EQ(check.laws.size(), laws.size());
    for (const LawCheck& law : check.laws) EXPECT_TRUE(law.holds) << message(law);
  }
}

TEST(SystemCheck, AMistakeIsNamedWithItsLawItsEntryAndBothNumbers) {
  for (const Expectation& e : expectations) {
    const SystemCheck check = check_of(e.mistake);
    EXPECT_FALSE(check.holds());
    const LawCheck* law = check.find(e.law);
    ASSERT_NE(law, nullptr) << info(e.law).name;
    EXPECT_FALSE(law->holds) << message(*law);
    EXPECT_EQ(law->row, e.row) << message(*law);
    EXPECT_EQ(law->column, e.column) << message(*law);
    const std::string text = message(*law);
    const bool alike = detail::text_of(law->value, 9) == detail::text_of(law->expected, 9);
    const int digits = alike ? 17 : 9;
    for (const std::string& part :
         {std::string(info(e.law).name) + " fails", e.row, e.column, detail::text_of(law->value, digits),
          detail::text_of(law->expected, digits)})
      EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks " << part;
  }
}

TEST(SystemCheck, AWrongSignIsSeenInTheNumbers) {
  for (const Mistake mistake : {Mistake::gradient_sign, Mistake::gradient_derivative, Mistake::damping,
                                Mistake::stiffness, Mistake::rate})
    for (const Expectation& e : expectations) {
      if (e.mistake != mistake || e.law == Law::constraint_force) continue;
      const SystemCheck check = check_of(mistake);
      const LawCheck* law = check.find(e.law);
      EXPECT_NEAR(law->value, -law->expected, law->tolerance()) << message(*law);
      EXPECT_GT(std::abs(law->value), 0.01) << message(*law);
    }
}

TEST(SystemCheck, AnIndefiniteMassIsNamedWithItsEigenvalue) {
  const SystemCheck check = check_of(Mistake::indefinite_mass);
  const LawCheck* law = check.find(Law::mass_definiteness);
  EXPECT_FALSE(law->holds);
  EXPECT_LT(law->value, 0.0) << message(*law);
  EXPECT_TRUE(law->row == "v[3]" || law->row == "v[4]") << message(*law);
  EXPECT_EQ(law->column, "");
  // No acceleration follows from it.
  EXPECT_EQ(check.find(Law::consistent_acceleration), nullptr);
}

TEST(SystemCheck, AMassOutsideItsBlocksIsNamed) {
  const LawCheck law = *check_of(Mistake::coupled_blocks).find(Law::mass_blocks);
  EXPECT_FALSE(law.holds);
  EXPECT_EQ(law.value, 1e-9);
  EXPECT_EQ(law.expected, 0.0);
}

TEST(SystemCheck, AWrongCurvatureIsSeenByItselfAndInTheAcceleration) {
  const SystemCheck check = check_of(Mistake::coriolis);
  for (const LawCheck& law : check.laws) {
    const bool touched = law.law == Law::constraint_curvature || law.law == Law::consistent_acceleration;
    EXPECT_EQ(law.holds, !touched) << message(law);
  }
  // d^2 Phi / dt^2 along that motion is what was forgotten, Omega x R^T u.
  const HeavyTopR3xSO3<double> top(upright());
  const Eigen::Matrix<double, 6, 1> v = top.initial_velocity();
  const Eigen::Vector3d forgotten = v.tail<3>().cross(v.head<3>());
  EXPECT_NEAR(check.find(Law::consistent_acceleration)->difference(), forgotten.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SystemCheck, AWrongEnergyIsSeenInItsBalance) {
  const SystemCheck potential = check_of(Mistake::potential_sign);
  const LawCheck* law = potential.find(Law::energy_balance);
  EXPECT_FALSE(law->holds);
  EXPECT_TRUE(potential.find(Law::kinetic_energy)->holds);
  EXPECT_GT(law->difference(), 1e6 * law->tolerance()) << message(*law);
  EXPECT_EQ(law->row.substr(0, 6), "along ") << message(*law);

  const SystemCheck kinetic = check_of(Mistake::kinetic_energy);
  law = kinetic.find(Law::kinetic_energy);
  EXPECT_FALSE(law->holds);
  EXPECT_NEAR(law->value, 2.0 * law->expected, 1e-9) << message(*law);
}

TEST(SystemCheck, AnotherSystemInTheOtherScalarIsNoWitness) {
  const LawCheck law = *check_of(Mistake::other_scalar).find(Law::scalars);
  EXPECT_FALSE(law.holds);
  // 1e-9 kg of 3.
  EXPECT_GT(law.difference(), 1e-10 * std::abs(law.value)) << message(law);
}

TEST(SystemCheck, ANumberThatIsNoneFailsWhereItStands) {
  const SystemCheck check = check_of(Mistake::not_a_number);
  const LawCheck* law = check.find(Law::scalars);
  EXPECT_FALSE(law->holds);
  EXPECT_GT(law->point, 0);
  EXPECT_NE(message(*law).find("nan"), std::string::npos) << message(*law);
}

TEST(SystemCheck, JointsMayBeOpenAsFarAsRunsCloseThem) {
  EXPECT_FALSE(check_of(Mistake::open_joint).find(Law::position_constraint)->holds);
  EXPECT_TRUE(check_of(Mistake::open_joint, {.gap = 1e-8}).find(Law::position_constraint)->holds);
}

TEST(SystemCheck, EntriesHaveTheNamesOfTheirProblem) {
  const SystemCheck check =
      check_of(Mistake::gradient_sign, {.names = {.velocities = {"x", "y", "z", "turn x", "turn y", "turn z"},
                                                  .multipliers = {"p", "q", "r"}}});
  EXPECT_EQ(entry_name(*check.find(Law::constraint_gradient)), "row q, column turn z");
}

TEST(SystemCheck, DifferencesInDoubleFindASignToo) {
  const MistakenTop<double> right(upright(), Mistake::none), wrong(upright(), Mistake::gradient_sign);
  const SystemCheck good = check_system(right, right), bad = check_system(wrong, wrong);
  EXPECT_FALSE(good.extended);
  EXPECT_EQ(good.find(Law::scalars), nullptr);
  for (const LawCheck& law : good.laws) EXPECT_TRUE(law.holds) << message(law);
  EXPECT_EQ(entry_name(*bad.find(Law::constraint_gradient)), "row lambda[1], column v[5]");
  EXPECT_FALSE(bad.find(Law::constraint_gradient)->holds);
}

TEST(SystemCheck, ALawThatDoesNotApplyIsNotThere) {
  // An oscillator that a negative damping feeds: its power is that of its damping.
  const SystemCheck check = check_system(LinearOscillator<double>(-1.0, 4.0));
  for (const LawCheck& law : check.laws) EXPECT_TRUE(law.holds) << message(law);
  EXPECT_NE(check.find(Law::energy_balance), nullptr);
  for (const Law law : {Law::constraint_gradient, Law::position_constraint, Law::independent_constraints})
    EXPECT_EQ(check.find(law), nullptr) << info(law).name;
}

TEST(SystemCheck, ALoadWithoutAPotentialNeedsItsPower) {
  const Oscillators<double, 3> system;
  EXPECT_FALSE(check_system(system).find(Law::energy_balance)->holds);
}

TEST(SystemCheck, ConstraintsThatSayTheSameAreNotIndependent) {
  const SystemCheck check = check_system(Particle<double, RedundantConstraint>());
  const LawCheck* law = check.find(Law::independent_constraints);
  EXPECT_FALSE(law->holds);
  EXPECT_LT(law->value, 1e-7);
  EXPECT_TRUE(law->row == "lambda[0]" || law->row == "lambda[1]");
  EXPECT_EQ(check.find(Law::consistent_acceleration), nullptr);
}

TEST(SystemCheck, NumbersThatLookAlikeAreWrittenInFull) {
  LawCheck law;
  law.law = Law::damping;
  law.holds = false;
  law.row = law.column = "v[0]";
  law.value = 1.0;
  law.expected = 1.0 + 4 * double_eps;
  EXPECT_NE(message(law).find("1 where 1.0000000000000009 is expected"), std::string::npos) << message(law);
  law.expected = 2.0;
  EXPECT_NE(message(law).find("1 where 2 is expected"), std::string::npos) << message(law);
}

TEST(SystemCheck, LawsAreListedInTheirOrder) {
  for (std::size_t i = 0; i < laws.size(); ++i) EXPECT_EQ(std::size_t(laws[i].law), i) << laws[i].name;
}

}  // namespace
}  // namespace liebench::system_check_test
