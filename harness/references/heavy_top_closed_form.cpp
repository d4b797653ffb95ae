#include "harness/references/heavy_top_closed_form.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/multiprecision/cpp_complex.hpp>
#include <utility>

namespace liebench {

namespace {

using Complex = boost::multiprecision::number<
    boost::multiprecision::complex_adaptor<boost::multiprecision::cpp_bin_float<50>>,
    boost::multiprecision::et_off>;

const Wide pi = boost::math::constants::pi<Wide>();

Complex imaginary(const Wide& x) {
  return {Wide(0), x};
}

// theta_1(v, q) / (2 q^{1/4}) and its derivative; the factor cancels from every use.
struct Theta1 {
  Complex value;
  Complex derivative;

  Theta1(const Complex& v, const Wide& q) : value(0), derivative(0) {
    const Wide growth = exp(2 * abs(v.imag()));
    Wide power = 1;      // (-1)^n q^{n (n + 1)}
    Wide ratio = q * q;  // q^{2 n + 2}
    Wide bound = 1;      // of the n-th term, the first being 1
    for (int n = 0; n < 1000; ++n) {
      const Complex angle = v * Wide(2 * n + 1);
      value += sin(angle) * power;
      derivative += cos(angle) * (power * (2 * n + 1));
      power *= -ratio;
      bound *= ratio * growth;
      ratio *= q * q;
      if (bound < Wide("1e-60")) break;
    }
  }

  Complex logarithmic_derivative() const { return derivative / value; }
};

// The right-handed orthonormal frame whose third column is n / |n|.
WideMatrix frame_about(WideVector n) {
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (abs(n[i]) < abs(n[smallest])) smallest = i;
  }
  WideVector axis{0, 0, 0};
  axis[smallest] = 1;
  WideVector x = cross(axis, n);
  const auto normalize = [](WideVector& v) {
    const Wide length = sqrt(dot(v, v));
    for (Wide& c : v) c /= length;
  };
  normalize(n);
  normalize(x);
  return transposed({x, cross(n, x), n});
}

// Shepperd's quaternion (w, x, y, z) of R: the largest component from the diagonal, the others by division.
std::array<Wide, 4> quaternion(const WideMatrix& R) {
  const Wide trace = R[0][0] + R[1][1] + R[2][2];
  const std::array<Wide, 4> squares = {1 + trace, 1 - trace + 2 * R[0][0], 1 - trace + 2 * R[1][1],
                                       1 - trace + 2 * R[2][2]};  // 4 times those of the components
  const auto largest =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  std::array<Wide, 4> p;
  p[largest] = sqrt(squares[largest]) / 2;
  const Wide f = 1 / (4 * p[largest]);
  if (largest == 0) {
    for (std::size_t i = 0; i < 3; ++i)
      p[i + 1] = f * (R[(i + 2) % 3][(i + 1) % 3] - R[(i + 1) % 3][(i + 2) % 3]);
    return p;
  }
  const std::size_t i = largest - 1;
  const std::size_t j = (i + 1) % 3;
  const std::size_t k = (i + 2) % 3;
  p[0] = f * (R[k][j] - R[j][k]);
  p[j + 1] = f * (R[j][i] + R[i][j]);
  p[k + 1] = f * (R[k][i] + R[i][k]);
  return p;
}

}  // namespace

struct HeavyTopClosedForm::Constants {
  // One of alpha(t), beta(t), in the letters of alpha: x_0 Q_a(t) / Q_a(0) exp(i r_a t).
  struct CayleyKlein {
    Complex initial;  // x_0 / Q_a(0)
    Complex shift;    // v_a
    Wide rate;        // r_a
  };

  WideMatrix S;  // frame about e, inertial coordinates
  WideMatrix B;  // frame about a, body coordinates
  Wide w;
  Wide w1;
  Wide nome;
  Complex v0;
  CayleyKlein alpha;
  CayleyKlein beta;

  Complex phase(const Wide& t) const { return v0 + t * pi / (2 * w1); }

  CayleyKlein component(const Complex& x0, const Complex& a, const Wide& spin) const {
    CayleyKlein c;
    c.shift = a * pi / (2 * w1);
    const Complex log_derivative = Theta1(c.shift, nome).logarithmic_derivative();
    c.initial = x0 * Theta1(v0, nome).value / Theta1(v0 + c.shift, nome).value;
    // a is imaginary up to a half-period w1, therefore L(v_a) is imaginary and |exp| is 1.
    c.rate = spin / 2 - pi * log_derivative.imag() / (2 * w1);
    return c;
  }
};

std::optional<HeavyTopClosedForm> HeavyTopClosedForm::of(const HeavyTopParameters& parameters) {
  const HeavyTopWideData data(parameters);
  const WideMatrix& J = data.inertia;
  const Wide weight = sqrt(dot(data.first_moment, data.first_moment) * dot(data.gravity, data.gravity));
  if (weight == 0) return std::nullopt;

  auto c = std::make_shared<Constants>();
  c->S = frame_about({-data.gravity[0], -data.gravity[1], -data.gravity[2]});
  // A negative mass points the first moment away from X; the axis follows the moment, and the formulas hold.
  c->B = frame_about(data.first_moment);
  const WideMatrix inertia = multiply(transposed(c->B), multiply(J, c->B));
  const Wide A = (inertia[0][0] + inertia[1][1]) / 2;
  const Wide C = inertia[2][2];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Wide symmetric = i != j ? Wide(0) : i < 2 ? A : C;
      if (abs(inertia[i][j] - symmetric) > Wide("1e-45") * (A + C)) return std::nullopt;
    }
  }

  const WideMatrix start = multiply(transposed(c->S), multiply(rotation_matrix(data.orientation), c->B));
  const WideVector omega = multiply(transposed(c->B), data.omega);
  const WideVector& up = start[2];  // e in the body's frame
  const Wide& u0 = up[2];
  const Wide du0 = up[0] * omega[1] - up[1] * omega[0];
  c->w = omega[2];
  const Wide b = C * c->w / A;
  const Wide be = 2 * weight / A;
  const Wide transverse = omega[0] * omega[0] + omega[1] * omega[1];
  const Wide p = omega[0] * up[0] + omega[1] * up[1] + b * u0;
  const Wide h = transverse + be * u0;

  // The roots, x_i = u_i - mean, by Viete's cosine; Newton steps take off its rounding.
  const Wide mean = (h + b * b) / (3 * be);
  const Wide c1 = 2 * p * b / be - 1;
  const Wide c0 = (h - p * p) / be;
  const Wide P = c1 - 3 * mean * mean;
  const Wide Q = mean * (c1 - 2 * mean * mean) + c0;
  if (!(P < 0)) return std::nullopt;
  const Wide m = 2 * sqrt(-P / 3);
  const Wide cosine = 3 * Q / (P * m);
  if (abs(cosine) > 1) return std::nullopt;
  std::array<Wide, 3> u;
  for (int k = 0; k < 3; ++k) {
    Wide x = m * cos((acos(cosine) - 2 * pi * k) / 3);
    for (int i = 0; i < 2; ++i) {
      const Wide slope = 3 * x * x + P;
      if (slope == 0) return std::nullopt;
      x -= ((x * x + P) * x + Q) / slope;
    }
    u[static_cast<std::size_t>(k)] = x + mean;
  }
  std::sort(u.begin(), u.end());
  const Wide spread = u[2] - u[0];
  if (u[1] - u[0] < Wide("1e-6") * spread || u[2] - u[1] < Wide("1e-6") * spread) return std::nullopt;

  // e_i - e_j = be / 4 (u_i - u_j), with e_1 <-> u[2], e_2 <-> u[1], e_3 <-> u[0].
  const Wide scale = be / 4;
  const Wide root = sqrt(scale * spread);  // sqrt(e_1 - e_3)
  const Wide k2 = (u[1] - u[0]) / spread;
  using boost::math::ellint_rf;
  const Wide K = ellint_rf(Wide(0), Wide(1 - k2), Wide(1));
  const Wide K_prime = ellint_rf(Wide(0), k2, Wide(1));
  c->w1 = K / root;
  const Wide w3 = K_prime / root;  // times i
  c->nome = exp(-pi * K_prime / K);

  // tau from u_0 = u_1 + (u_2 - u_1) sn^2, u'_0 = 2 (u_2 - u_1) sn cn dn sqrt(e_1 - e_3). Close to a turning
  // point the square root of u_0 - u_i would lose half of the digits; there the velocity gives that factor.
  const Wide sn2 = std::clamp(Wide((u0 - u[0]) / (u[1] - u[0])), Wide(0), Wide(1));
  const Wide dn2 = 1 - k2 * sn2;
  const Wide velocity = du0 / (2 * (u[1] - u[0]) * sqrt(dn2) * root);  // sn cn
  Wide F;
  if (sn2 > 0.5) {
    const Wide sn = sqrt(sn2);
    const Wide cn = velocity / sn;
    F = sn * ellint_rf(Wide(cn * cn), dn2, Wide(1));
    if (cn < 0) F = 2 * K - F;
  } else {
    const Wide cn = sqrt(1 - sn2);
    const Wide sn = velocity / cn;
    F = sn * ellint_rf(Wide(cn * cn), dn2, Wide(1));
  }
  c->v0 = Complex(F / root, w3) * pi / (2 * c->w1);

  // The distances of the roots from +-1. One of each product may be all cancellation, f(+-1) = -(p -+ b)^2
  // has its digits.
  const Wide below = (p + b) * (p + b) / (be * (1 + u[1]) * (1 + u[2]));  // u_1 + 1
  Wide above = u[2] - 1;
  Wide short_of = 1 - u[1];
  const Wide product = (p - b) * (p - b) / (be * (1 - u[0]));
  if (above < short_of) {
    above = product / short_of;
  } else {
    short_of = product / above;
  }

  const Wide a = ellint_rf(Wide(scale * below), Wide(scale * (1 + u[1])), Wide(scale * (1 + u[2])));
  // c = w_1 + i s, where P(i s) = y' belongs to u = 1 by the shift of P by w_1.
  Wide s = 0;
  if (above > 0) {
    const Wide first = scale * (u[2] - u[1]) * spread / above;       // e_1 - y'
    const Wide second = scale * (u[2] - u[1]) * (1 - u[0]) / above;  // e_2 - y'
    const Wide third = scale * spread * short_of / above;            // e_3 - y'
    s = ellint_rf(third, second, first);
  }

  const std::array<Wide, 4> q0 = quaternion(start);
  const Complex alpha0(q0[0], q0[3]);
  const Complex beta0(q0[1], q0[2]);
  if (std::min(norm(alpha0), norm(beta0)) < Wide("1e-10") / 4) return std::nullopt;
  c->alpha = c->component(alpha0, imaginary(p + b < 0 ? Wide(-a) : a), c->w - b);
  c->beta = c->component(beta0, Complex(c->w1, p - b < 0 ? Wide(-s) : s), b - c->w);
  return HeavyTopClosedForm(std::move(c));
}

HeavyTopWitness HeavyTopClosedForm::at(double time) const {
  const Constants& c = *constants_;
  const Wide t = time;
  const Complex v = c.phase(t);
  const Theta1 theta(v, c.nome);
  const Wide unit = pi / (2 * c.w1);
  const auto evaluate = [&](const Constants::CayleyKlein& x) {
    const Theta1 shifted(v + x.shift, c.nome);
    const Complex front = x.initial * exp(imaginary(x.rate * t)) / theta.value;
    const Complex value = front * shifted.value;
    // x' = x (unit (L(v + v_a) - L(v)) + i rate), without dividing by theta_1(v + v_a), which may vanish.
    const Complex derivative = front * shifted.derivative * unit +
                               value * (imaginary(x.rate) - theta.logarithmic_derivative() * unit);
    return std::pair(value, derivative);
  };
  const auto [alpha, alpha_dot] = evaluate(c.alpha);
  const auto [beta, beta_dot] = evaluate(c.beta);
  // From p' = 1/2 p (0, Omega): Omega_1 + i Omega_2 = 2 (conj(alpha) beta' - beta conj(alpha')).
  const Complex transverse = (conj(alpha) * beta_dot - beta * conj(alpha_dot)) * Wide(2);

  HeavyTopWitness witness;
  witness.t = time;
  const WideMatrix R = rotation_matrix({alpha.real(), beta.real(), beta.imag(), alpha.imag()});
  witness.R = multiply(c.S, multiply(R, transposed(c.B)));
  witness.omega = multiply(c.B, WideVector{transverse.real(), transverse.imag(), c.w});
  return witness;
}

double HeavyTopClosedForm::nutation_period() const {
  return Wide(2 * constants_->w1).convert_to<double>();
}

}  // namespace liebench
