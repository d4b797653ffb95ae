#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "problems/law_differences.h"
#include "problems/system_check.h"

// The laws of a mechanical system at one point, on vectors and matrices of any size: compiled once for a scalar of the differences,
// not once for each system. check_system() (problems/check_system.h) gives them a system.

namespace liebench {

// Where laws are looked at: beside q, any velocity, acceleration and multipliers.
struct CheckPoint {
  int number = 0;  // 0: the initial values
  double t = 0.0;
  CheckVector v, a, lambda;
  double coordinates = 1.0;  // the largest of q, or 1
};

// What a system says of itself there, in double. Of matrices that it does not give nothing.
struct StatedValues {
  CheckVector force, constraint, rate, curvature;
  CheckMatrix momentum;                              // M, column by column
  CheckMatrix constraint_force, constraint_product;  // B, row by row and column by column
  std::optional<CheckMatrix> mass, gradient, gradient_derivative, damping, stiffness;
  double energy = 0.0;

  const CheckMatrix& M() const { return mass ? *mass : momentum; }
  const CheckMatrix& B() const { return gradient ? *gradient : constraint_product; }
};

// The same system about the point in the scalar T of the differences: at q o exp(w~).
template <class T>
class SystemWitness {
 public:
  using Vector = WitnessVector<T>;
  virtual ~SystemWitness() = default;
  virtual Vector momentum(const Vector& w, const Vector& a) const = 0;
  virtual Vector force(const T& t, const Vector& w, const Vector& v) const = 0;
  virtual T energy(const Vector& w, const Vector& v) const = 0;
  // Of the forces that have no potential.
  virtual T power(const T& t, const Vector& v) const = 0;
  virtual Vector constraint(const T& t, const Vector& w) const = 0;
  virtual Vector constraint_force(const Vector& w, const Vector& lambda) const = 0;
  virtual Vector constraint_product(const Vector& w, const Vector& v) const = 0;
};

// The worst entry of each law.
class LawChecks {
 public:
  explicit LawChecks(const EntryNames& names) : names_(names) { worst_.fill(-1.0); }

  // The entry at (row, column) of the law; the names are made only where it is the worst up to now.
  template <class Row, class Column>
  void compare(Law law, const CheckPoint& point, const Row& row, const Column& column, double value,
               double expected, double round_off, double difference_error) {
    LawCheck& check = at(law);
    ++check.compared;
    const double difference = std::abs(value - expected), tolerance = round_off + difference_error;
    const bool holds = difference <= tolerance;
    double badness = difference == 0.0 ? 0.0 : difference / tolerance;
    if (!holds && !(badness > 1.0)) badness = std::numeric_limits<double>::infinity();
    take(check, badness, holds, point, row, column, value, expected, round_off, difference_error);
  }
  // A number that is to be larger than its round-off.
  template <class Row>
  void bound(Law law, const CheckPoint& point, const Row& row, double value, double round_off) {
    LawCheck& check = at(law);
    ++check.compared;
    const bool holds = value > round_off;
    const double badness = holds ? round_off / value : 2.0 - value;
    take(check, std::isnan(badness) ? std::numeric_limits<double>::infinity() : badness, holds, point, row,
         none, value, 0.0, round_off, 0.0);
  }
  bool holds(Law law) const { return checks_[std::size_t(law)].holds; }

  auto velocity(Eigen::Index i) const {
    return [this, i] { return names_.velocity(i); };
  }
  auto multiplier(Eigen::Index i) const {
    return [this, i] { return names_.multiplier(i); };
  }
  static constexpr auto none = [] { return std::string(); };

  std::vector<LawCheck> result() const {
    std::vector<LawCheck> list;
    for (const LawCheck& check : checks_)
      if (check.compared > 0) list.push_back(check);
    return list;
  }

 private:
  LawCheck& at(Law law) {
    LawCheck& check = checks_[std::size_t(law)];
    check.law = law;
    return check;
  }
  template <class Row, class Column>
  void take(LawCheck& check, double badness, bool holds, const CheckPoint& point, const Row& row,
            const Column& column, double value, double expected, double round_off, double difference_error) {
    double& worst = worst_[std::size_t(check.law)];
    if (!(badness > worst)) return;
    worst = badness;
    check.holds = holds;
    check.point = point.number;
    check.row = row();
    check.column = column();
    check.value = value;
    check.expected = expected;
    check.round_off = round_off;
    check.difference_error = difference_error;
  }

  const EntryNames& names_;
  std::array<LawCheck, laws.size()> checks_;
  std::array<double, laws.size()> worst_{};
};

// The least eigenvalue of a symmetric matrix and the largest entry of its vector.
struct LeastEigenvalue {
  double value = 0.0;
  Eigen::Index entry = 0;
};
inline LeastEigenvalue least_eigenvalue(const CheckMatrix& A) {
  const Eigen::SelfAdjointEigenSolver<CheckMatrix> solver(A);
  LeastEigenvalue least{solver.eigenvalues()(0), 0};
  solver.eigenvectors().col(0).cwiseAbs().maxCoeff(&least.entry);
  return least;
}

// All laws at one point.
template <class T>
class LawsAtPoint {
 public:
  // `rounded`: the stated values after q and v moved by 64 roundings; what they change by is noise.
  LawsAtPoint(LawChecks& checks, const CheckPoint& point, const StatedValues& stated,
              const StatedValues& rounded, const SystemWitness<T>& witness)
      : checks_(checks),
        point_(point),
        stated_(stated),
        rounded_(rounded),
        witness_(witness),
        t_(point.t),
        v_(in_witness(point.v)),
        a_(in_witness(point.a)),
        lambda_(in_witness(point.lambda)),
        zero_(WitnessVector<T>::Constant(point.v.size(), T(0.0))) {}

  void check(bool twin) const {
    if (twin) check_scalars();
    check_mass();
    check_forces();
    check_energy();
    if (multipliers() > 0) check_constraints();
  }
  void check_constant_mass(const CheckMatrix& initial) const {
    compare_matrices(Law::constant_mass, stated_.M(), initial, noise(initial, initial), false);
  }
  void check_mass_blocks(Eigen::Index block) const {
    const CheckMatrix& M = stated_.M();
    for (Eigen::Index j = 0; j < velocities(); ++j)
      for (Eigen::Index i = 0; i < velocities(); ++i)
        if (i / block != j / block)
          checks_.compare(Law::mass_blocks, point_, checks_.velocity(i), checks_.velocity(j), M(i, j), 0.0,
                          0.0, 0.0);
  }
  // `gap`: how far joints may be open where a run begins by closing them.
  void check_initial_values(double gap) const {
    if (multipliers() == 0) return;
    const auto row = [&](Law law, const CheckVector& value, double noise) {
      for (Eigen::Index i = 0; i < value.size(); ++i)
        checks_.compare(law, point_, checks_.multiplier(i), LawChecks::none, value(i), 0.0, noise, 0.0);
    };
    row(Law::position_constraint, stated_.constraint,
        gap + noise(stated_.constraint, rounded_.constraint, point_.coordinates * max_norm(stated_.B())));
    row(Law::velocity_constraint, stated_.rate,
        noise(stated_.rate, rounded_.rate, max_norm(absolute(stated_.B()) * absolute(point_.v))));
    check_independence();
    if (checks_.holds(Law::independent_constraints) && checks_.holds(Law::mass_definiteness))
      check_acceleration();
  }

 private:
  using Vector = WitnessVector<T>;

  Eigen::Index velocities() const { return point_.v.size(); }
  Eigen::Index multipliers() const { return point_.lambda.size(); }
  static Vector in_witness(const CheckVector& x) { return x.template cast<T>(); }
  Vector along(Eigen::Index j, const T& s) const {
    Vector w = zero_;
    w(j) = s;
    return w;
  }
  template <class Derived>
  static CheckMatrix absolute(const Eigen::MatrixBase<Derived>& A) {
    return A.cwiseAbs();
  }
  // 64 roundings of the largest term, and what those of q and v change.
  template <class A, class B>
  static double noise(const A& value, const B& rounded, double largest = 0.0) {
    return roundings * double_eps * std::max(largest, max_norm(value)) + max_norm(value - rounded);
  }
  double speed() const { return std::max(1.0, max_norm(point_.v)); }

  // Column j of a stated matrix against a derivative along e_j.
  template <class F>
  void compare_columns(Law law, const CheckMatrix& stated, double round_off, bool rows_are_multipliers,
                       double unit, double argument, const F& function) const {
    for (Eigen::Index j = 0; j < velocities(); ++j) {
      const SidedDerivative D =
          sided_derivative<T>([&](const T& s) { return function(along(j, s)); }, unit, argument);
      for (Eigen::Index i = 0; i < stated.rows(); ++i) {
        const double expected = D.nearest(i, stated(i, j));
        if (rows_are_multipliers)
          checks_.compare(law, point_, checks_.multiplier(i), checks_.velocity(j), stated(i, j), expected,
                          round_off, D.error(i));
        else
          checks_.compare(law, point_, checks_.velocity(i), checks_.velocity(j), stated(i, j), expected,
                          round_off, D.error(i));
      }
    }
  }
  void compare_matrices(Law law, const CheckMatrix& value, const CheckMatrix& expected, double round_off,
                        bool rows_are_multipliers) const {
    for (Eigen::Index j = 0; j < value.cols(); ++j)
      for (Eigen::Index i = 0; i < value.rows(); ++i)
        if (rows_are_multipliers)
          checks_.compare(law, point_, checks_.multiplier(i), checks_.velocity(j), value(i, j),
                          expected(i, j), round_off, 0.0);
        else
          checks_.compare(law, point_, checks_.velocity(i), checks_.velocity(j), value(i, j), expected(i, j),
                          round_off, 0.0);
  }

  void check_scalars() const {
    const auto compare = [&](const CheckVector& value, const CheckVector& rounded, const Vector& other,
                             double largest, const auto& name) {
      const double tolerance = noise(value, rounded, largest);
      for (Eigen::Index i = 0; i < value.size(); ++i)
        checks_.compare(
            Law::scalars, point_, [&] { return name(i); }, LawChecks::none, value(i), to_double(other(i)),
            tolerance, 0.0);
    };
    const auto of_velocity = [&](const char* what) {
      return [this, what](Eigen::Index i) { return what + checks_.velocity(i)(); };
    };
    compare(stated_.force, rounded_.force, witness_.force(t_, zero_, v_), 0.0, of_velocity("force "));
    for (Eigen::Index j = 0; j < velocities(); ++j)
      compare(stated_.momentum.col(j), rounded_.momentum.col(j), witness_.momentum(zero_, along(j, T(1.0))),
              max_norm(stated_.momentum), of_velocity("momentum "));
    const auto energy = [](double x) { return CheckVector(CheckVector::Constant(1, x)); };
    compare(energy(stated_.energy), energy(rounded_.energy), Vector::Constant(1, witness_.energy(zero_, v_)),
            0.5 * max_norm(absolute(point_.v.transpose()) * (absolute(stated_.M()) * absolute(point_.v))),
            [](Eigen::Index) { return std::string("energy"); });
    if (multipliers() > 0)
      compare(stated_.constraint, rounded_.constraint, witness_.constraint(t_, zero_),
              point_.coordinates * max_norm(stated_.B()),
              [this](Eigen::Index i) { return "constraint " + checks_.multiplier(i)(); });
  }

  void check_mass() const {
    const CheckMatrix& M = stated_.M();
    const double round_off = noise(M, rounded_.M());
    for (Eigen::Index j = 0; j < velocities(); ++j)
      for (Eigen::Index i = j + 1; i < velocities(); ++i)
        checks_.compare(Law::mass_symmetry, point_, checks_.velocity(i), checks_.velocity(j), M(i, j),
                        M(j, i), round_off, 0.0);
    if (stated_.mass) compare_matrices(Law::momentum, stated_.momentum, M, round_off, false);
    check_definiteness(M);
  }
  // Scaled to a diagonal of 1, so that a gram of one body may stand beside a tonne of another: definiteness does not change (Sylvester).
  void check_definiteness(const CheckMatrix& M) const {
    Eigen::Index least = 0;
    if (const double entry = M.diagonal().minCoeff(&least); !(entry > 0.0) || !M.allFinite())
      return checks_.bound(Law::mass_definiteness, point_, checks_.velocity(least), entry, 0.0);
    const CheckVector scale = M.diagonal().cwiseSqrt().cwiseInverse();
    const CheckMatrix scaled =
        scale.asDiagonal() * CheckMatrix(0.5 * (M + M.transpose())) * scale.asDiagonal();
    const LeastEigenvalue eigenvalue = least_eigenvalue(scaled);
    checks_.bound(Law::mass_definiteness, point_, checks_.velocity(eigenvalue.entry), eigenvalue.value,
                  roundings * double_eps);
  }

  double largest_force() const {
    double largest = std::max(max_norm(stated_.force), max_norm(stated_.M() * point_.a));
    if (multipliers() > 0)
      largest = std::max(largest, max_norm(absolute(stated_.B()).transpose() * absolute(point_.lambda)));
    return largest;
  }
  void check_forces() const {
    if (stated_.damping)
      compare_columns(Law::damping, *stated_.damping,
                      noise(*stated_.damping, *rounded_.damping, max_norm(stated_.force)), false, speed(),
                      speed(), [&](const Vector& dv) { return witness_.force(t_, zero_, Vector(v_ + dv)); });
    if (stated_.stiffness)
      compare_columns(Law::stiffness, *stated_.stiffness,
                      noise(*stated_.stiffness, *rounded_.stiffness, largest_force()), false,
                      point_.coordinates, point_.coordinates, [&](const Vector& w) {
                        Vector r = witness_.momentum(w, a_) + witness_.force(t_, w, v_);
                        if (multipliers() > 0) r += witness_.constraint_force(w, lambda_);
                        return r;
                      });
  }

  void check_energy() const {
    const CheckVector Mv = stated_.M() * point_.v;
    for (Eigen::Index i = 0; i < velocities(); ++i) {
      const SidedDerivative D = sided_derivative<T>(
          [&](const T& s) {
            return Vector(Vector::Constant(1, witness_.energy(zero_, Vector(v_ + along(i, s)))));
          },
          speed(), speed());
      checks_.compare(Law::kinetic_energy, point_, checks_.velocity(i), LawChecks::none, D.nearest(0, Mv(i)),
                      Mv(i), roundings * double_eps * max_norm(absolute(stated_.M()) * absolute(point_.v)),
                      D.error(0));
    }
    check_balance(v_, a_, [] { return std::string("along v and a of the point"); });
    for (Eigen::Index j = 0; j < velocities(); ++j)
      check_balance(along(j, T(1.0)), zero_, [&] { return "along " + checks_.velocity(j)(); });
  }
  // Any motion will do: where M a + g is not zero something else pushes, and its power v . (M a + g) is the first part of dE/dt.
  template <class Name>
  void check_balance(const Vector& v, const Vector& a, const Name& name) const {
    const double fastest = std::max(1.0, max_norm(v));
    const Vector g = witness_.force(t_, zero_, v), Ma = witness_.momentum(zero_, a);
    const double expected = to_double(T(v.dot(Ma + g) + witness_.power(t_, v)));
    double terms = 0.0;
    for (Eigen::Index i = 0; i < v.size(); ++i)
      terms += std::abs(to_double(v(i))) * (std::abs(to_double(g(i))) + std::abs(to_double(Ma(i))));
    const SidedDerivative D = sided_derivative<T>(
        [&](const T& s) {
          return Vector(Vector::Constant(1, witness_.energy(Vector(v * s), Vector(v + a * s))));
        },
        point_.coordinates / fastest, point_.coordinates / fastest);
    checks_.compare(Law::energy_balance, point_, name, LawChecks::none, D.nearest(0, expected), expected,
                    roundings * double_eps * terms, D.error(0));
  }

  void check_constraints() const {
    const CheckMatrix& B = stated_.B();
    const double unit = point_.coordinates, round_off = noise(B, rounded_.B());
    compare_columns(Law::constraint_gradient, B, round_off, true, unit, unit,
                    [&](const Vector& w) { return witness_.constraint(t_, w); });
    if (stated_.gradient)
      compare_matrices(Law::constraint_product, stated_.constraint_product, B, round_off, true);
    compare_matrices(Law::constraint_force, stated_.constraint_force, B, round_off, true);

    const double time = 1.0 / speed(), rates = max_norm(absolute(B) * absolute(point_.v));
    const auto moving = [&](const T& s) { return witness_.constraint(T(t_ + s), Vector(v_ * s)); };
    const SidedDerivative rate = sided_derivative<T>(moving, unit * time, unit * time);
    for (Eigen::Index i = 0; i < multipliers(); ++i)
      checks_.compare(Law::constraint_rate, point_, checks_.multiplier(i), LawChecks::none, stated_.rate(i),
                      rate.nearest(i, stated_.rate(i)), noise(stated_.rate, rounded_.rate, rates),
                      rate.error(i));
    const SecondDerivative second = second_derivative<T>(moving, time, unit * std::max(1.0, max_norm(B)));
    for (Eigen::Index i = 0; i < multipliers(); ++i)
      checks_.compare(Law::constraint_curvature, point_, checks_.multiplier(i), LawChecks::none,
                      stated_.curvature(i), second.value(i),
                      noise(stated_.curvature, rounded_.curvature, rates * speed()), second.error(i));
    if (stated_.gradient_derivative)
      compare_columns(Law::gradient_derivative, *stated_.gradient_derivative,
                      noise(*stated_.gradient_derivative, *rounded_.gradient_derivative, rates), true, unit,
                      unit, [&](const Vector& w) { return witness_.constraint_product(w, v_); });
  }

  void check_independence() const {
    CheckMatrix B = stated_.B();
    for (Eigen::Index i = 0; i < B.rows(); ++i) {
      const double length = B.row(i).norm();
      if (!(length > 0.0))
        return checks_.bound(Law::independent_constraints, point_, checks_.multiplier(i), length, 0.0);
      B.row(i) /= length;
    }
    // The squares of the singular values: half of the digits are left of them.
    const LeastEigenvalue square = least_eigenvalue(B * B.transpose());
    checks_.bound(Law::independent_constraints, point_, checks_.multiplier(square.entry),
                  std::sqrt(std::max(0.0, square.value)),
                  std::sqrt(roundings * double_eps * double(B.rows())));
  }
  // [M B^T; B 0] (a, lambda) = (-g, -Z), with two passes of refinement: its residual is round-off whatever the condition. What is
  // looked at is not this residual but the constraint along the motion.
  void check_acceleration() const {
    const Eigen::Index m = velocities(), l = multipliers();
    CheckMatrix A = CheckMatrix::Zero(m + l, m + l);
    A.topLeftCorner(m, m) = stated_.M();
    A.topRightCorner(m, l) = stated_.B().transpose();
    A.bottomLeftCorner(l, m) = stated_.B();
    CheckVector right(m + l), x = CheckVector::Zero(m + l);
    right << -stated_.force, -stated_.curvature;
    const Eigen::PartialPivLU<CheckMatrix> lu(A);
    for (int pass = 0; pass < 3; ++pass) x += lu.solve(CheckVector(right - A * x));
    const CheckVector acceleration = x.head(m);
    const Vector half = in_witness(acceleration) * T(0.5);
    const double terms =
        std::max(max_norm(stated_.curvature), max_norm(absolute(stated_.B()) * absolute(acceleration)));
    const double time = 1.0 / std::max(speed(), std::sqrt(max_norm(acceleration)));
    const SecondDerivative second = second_derivative<T>(
        [&](const T& s) { return witness_.constraint(T(t_ + s), Vector(v_ * s + half * T(s * s))); }, time,
        point_.coordinates * std::max(1.0, max_norm(stated_.B())));
    for (Eigen::Index i = 0; i < l; ++i)
      checks_.compare(
          Law::consistent_acceleration, point_, checks_.multiplier(i), LawChecks::none, second.value(i), 0.0,
          noise(stated_.curvature, rounded_.curvature, std::max(terms, speed() * speed())), second.error(i));
  }

  LawChecks& checks_;
  const CheckPoint& point_;
  const StatedValues& stated_;
  const StatedValues& rounded_;
  const SystemWitness<T>& witness_;
  T t_;
  Vector v_, a_, lambda_, zero_;
};

}  // namespace liebench
