#include "harness/references/heavy_top_reference.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <vector>

#include "heavy_top_samples.h"

namespace liebench {
namespace {

using Vector = Eigen::Matrix<Extended, 3, 1>;

// Built once: most of the cost of these tests.
const HeavyTopReference& fast_top() {
  static const HeavyTopReference reference(HeavyTopParameters{}, 2);
  return reference;
}

void expect_printed_vector(const Vector& v, const std::array<const char*, 3>& printed) {
  for (int i = 0; i < 3; ++i) expect_printed(to_wide(v[i]), printed[static_cast<std::size_t>(i)]);
}

// m (Omega x (Omega x X) + Omega' x X - R^T gamma), body frame.
Vector multiplier(const HeavyTopState& s) {
  const Vector X(0.0, 1.0, 0.0);
  const Vector gamma(0.0, 0.0, decimal<Extended>(-9.81));
  const Vector inner = s.omega.cross(X);
  return Extended(15.0) * (s.omega.cross(inner) + s.omega_dot.cross(X) - s.R.transpose() * gamma);
}

bool identical(const HeavyTopState& a, const HeavyTopState& b) {
  return a.orientation == b.orientation && a.R == b.R && a.omega == b.omega && a.omega_dot == b.omega_dot &&
         a.t == b.t;
}

// The digits of these three tests are those of the design notes, section 8.
TEST(HeavyTopReference, GivesThePublishedStateAtTwoSeconds) {
  const HeavyTopState s = fast_top().at(2.0);
  const std::array<const char*, 4> q{"0.1229471350415334671042516", "-0.4910798925500270146990447",
                                     "0.3504300303436209618390203", "-0.7879868875504856693241740"};
  for (int i = 0; i < 4; ++i) expect_printed(to_wide(s.orientation[i]), q[static_cast<std::size_t>(i)]);
  expect_printed_vector(
      s.R.row(0).transpose(),
      {"-0.4874490822362657103411955", "-0.1504168227456417598100308", "0.8600977686647771186846381"});
  expect_printed_vector(
      s.R.row(1).transpose(),
      {"-0.5379397438441505933085279", "-0.7241655916368956507485544", "-0.4315148060983244312796755"});
  expect_printed_vector(
      s.R.row(2).transpose(),
      {"0.6877602956117137709979559", "-0.6730222695604440960502210", "0.2720786659328456273933258"});
  expect_printed_vector(
      s.omega, {"0.1222332194973942367872815", "150.000000000000000000000000", "-5.85562458920545772829141"});
  expect_printed_vector(
      s.omega_dot, {"848.6896999749584266715569", "0.0000000000000000000000", "24.41395920380359864035642"});
  const Vector X(0.0, 1.0, 0.0);
  expect_printed_vector(s.R * X, {"-0.1504168227456417598100308", "-0.7241655916368956507485544",
                                  "-0.6730222695604440960502210"});
  expect_printed_vector(s.R * s.omega.cross(X), {"-2.749186312581890069763623", "-3.202718635574885479107584",
                                                 "4.060523149756693341085088"});
  expect_printed_vector(multiplier(s), {"10.01928331134673456838640", "-613.5844313106636047018688",
                                        "-404.7734503958852545113910"});
}

TEST(HeavyTopReference, GivesThePublishedStateAtOneSecond) {
  const HeavyTopState s = fast_top().at(1.0);
  expect_printed_vector(s.omega,
                        {"-0.82207810168270445626", "150.00000000000000000", "-5.9232913481173361861"});
  expect_printed_vector(multiplier(s),
                        {"-58.274563744197372699", "-646.55831191452542323", "-409.44140886346466182"});
  expect_printed(to_wide(s.orientation[0]), "0.73294398067966371815");
  expect_printed(to_wide(s.orientation[3]), "-0.32017614273624928141");
}

TEST(HeavyTopReference, GivesThePublishedStateAtHalfASecond) {
  const HeavyTopState s = fast_top().at(0.5);
  expect_printed_vector(s.omega,
                        {"-0.47105310174524884297", "150.00000000000000000", "5.9010830483264570279"});
  expect_printed_vector(multiplier(s),
                        {"-34.073314203233116797", "-630.3526304320980697", "407.90882311488120257"});
  expect_printed(to_wide(s.orientation[1]), "-0.70066289541220650374");
  expect_printed(to_wide(s.orientation[2]), "0.38432575302289440504");
}

TEST(HeavyTopReference, AcceleratesAtTheStartAsTheEquationsSay) {
  const HeavyTopState s = fast_top().at(0.0);
  // ((J_2 - J_3) Omega_2 Omega_3 - m g) / J_1 with the decimals of the data.
  const Wide expected = (Wide("-4.61538") * 150 * (Wide("0.46875") - Wide("15.234375")) - 15 * Wide("9.81")) /
                        Wide("15.234375");
  // Rounding of some ten double-double operations, 2^-104 each at worst.
  EXPECT_LT(abs(to_wide(s.omega_dot[0]) / expected - 1), Wide("1e-30"));
  EXPECT_TRUE(s.omega_dot[1] == 0.0 && s.omega_dot[2] == 0.0);
  // the design notes, section 7.1.
  expect_printed_vector(multiplier(s),
                        {"0.000000000000000000000000", "-319.525988166000000000", "-317.26246153846153846"});
}

TEST(HeavyTopReference, AgreesWithTheSpatialVelocityThatExudynQuotes) {
  const HeavyTopState s = fast_top().at(2.0);
  // the design notes, section 7.1: the closed form, and Exudyn's Runge-Kutta runs with 1e-14 and h = 2e-5.
  const double omega_y = to_double((s.R * s.omega)[1]);
  EXPECT_NEAR(omega_y, -106.16380414312445, 2e-14);
  EXPECT_NEAR(omega_y, -106.16380414311477, 2e-11);
}

TEST(HeavyTopReference, DerivativeOfOmegaIsOmegaDot) {
  // Central difference of order 6, whose error h^6 |Omega^(7)| / 140 is 150^7 h^6 / 20 = 2e-20 relative to
  // 1e-6 * 150 rounding 1e-31 / h: far below what a wrong sign would give.
  const Extended t = 0.7;
  const Extended h = 1e-6;
  const auto omega = [&](double k) { return fast_top().at(t + h * k).omega; };
  const Vector difference = (Extended(45.0) * (omega(1) - omega(-1)) -
                             Extended(9.0) * (omega(2) - omega(-2)) + (omega(3) - omega(-3))) /
                            Extended(h * 60.0);
  const Vector error = difference - fast_top().at(t).omega_dot;
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(to_double(error[i])), 1e-19);
}

TEST(HeavyTopReference, StatesItsErrorAndItsWitnesses) {
  EXPECT_GE(fast_top().error_estimate(), 1e-31);
  EXPECT_LT(fast_top().error_estimate(), 1e-28);  // what the issue asks for
  EXPECT_NE(fast_top().method().find("closed form"), std::string::npos);
}

TEST(HeavyTopReference, HasTwoWitnessesWithoutSymmetry) {
  const HeavyTopReference reference(unsymmetric_top(), 1);
  EXPECT_LT(reference.error_estimate(), 1e-28);
  EXPECT_EQ(reference.method().find("closed form"), std::string::npos);
  EXPECT_NE(reference.method().find("Gragg"), std::string::npos);
}

TEST(HeavyTopReference, ReachesTheMarginAndNoFurther) {
  EXPECT_NO_THROW(fast_top().at(2.05));
  EXPECT_THROW(fast_top().at(2.06), std::out_of_range);
  EXPECT_THROW(fast_top().at(-0.001), std::out_of_range);
}

TEST(HeavyTopReference, AnswersSeveralThreadsAlike) {
  std::vector<HeavyTopState> alone;
  for (int i = 0; i <= 100; ++i) alone.push_back(fast_top().at(i * 0.02));
  std::array<int, 4> equal{};
  std::vector<std::thread> threads;
  for (int& count : equal) {
    threads.emplace_back([&] {
      for (int i = 0; i <= 100; ++i)
        count += identical(fast_top().at(i * 0.02), alone[static_cast<std::size_t>(i)]);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : equal) EXPECT_EQ(count, 101);
}

// What a thread remembers of one solution is not taken for another's, nor a time for one that rounds to the same double.
TEST(HeavyTopReference, RemembersTimesOfItsOwn) {
  HeavyTopParameters p;
  p.angular_velocity = {0, 3, 1};
  const HeavyTopReference slow(p, 0.1, 0.0);
  const auto time = [](int i) { return Extended(0.001) * double(i); };
  // Threads that have asked for nothing else.
  const auto alone = [&](const HeavyTopReference& reference) {
    std::vector<HeavyTopState> states;
    std::thread([&] {
      for (int i = 0; i <= 20; ++i) states.push_back(reference.at(time(i)));
    }).join();
    return states;
  };
  const auto slow_alone = alone(slow), fast_alone = alone(fast_top());
  for (int round = 0; round < 3; ++round)
    for (int i = 0; i <= 20; ++i) {
      EXPECT_TRUE(identical(slow.at(time(i)), slow_alone[std::size_t(i)]));
      EXPECT_TRUE(identical(fast_top().at(time(i)), fast_alone[std::size_t(i)]));
    }
  EXPECT_FALSE(identical(slow_alone[20], fast_alone[20]));
  const Extended t = 0.05, next = t + Extended(1e-20);
  ASSERT_EQ(to_double(t), to_double(next));
  EXPECT_NE(to_double(Extended((slow.at(next).omega - slow.at(t).omega).norm())), 0.0);
}

// An upright top at rest: the rounding of 1e-50 alone decides whither it falls: 1e-50 exp(2.6 t) after t
// seconds.
TEST(HeavyTopReference, RefusesASolutionThatItsWitnessesDoNotConfirm) {
  HeavyTopParameters p;
  p.angular_velocity = {0, 0, 0};
  p.gravity = {2, 3, 6};           // of length 7
  p.orientation = {0, -2, 4, -6};  // the turn by pi about 7 e_2 - gamma: R e_2 = -gamma / 7
  EXPECT_LT(HeavyTopReference(p, 1).error_estimate(), 1e-28);
  EXPECT_THROW(HeavyTopReference(p, 60), std::runtime_error);
}

TEST(HeavyTopReference, RefusesBadInput) {
  EXPECT_THROW(HeavyTopReference(HeavyTopParameters{}, 0), std::invalid_argument);
  EXPECT_THROW(HeavyTopReference(HeavyTopParameters{}, std::nan("")), std::invalid_argument);
  EXPECT_THROW(HeavyTopReference(HeavyTopParameters{}, 1, -0.1), std::invalid_argument);
  HeavyTopParameters p;
  p.mass = std::nan("");
  EXPECT_THROW(HeavyTopReference(p, 1), std::invalid_argument);
}

class HeavyTopReferenceCacheTest : public testing::Test {
 protected:
  HeavyTopReferenceCacheTest() {
    std::string pattern = testing::TempDir() + "liebench_heavy_top_XXXXXX";
    directory_ = ::mkdtemp(pattern.data());
  }
  ~HeavyTopReferenceCacheTest() override { std::filesystem::remove_all(directory_); }

  HeavyTopReference load(double t_end = 0.05, double margin = 0.01) {
    const MessageCallback message = [this](std::string_view text) { messages_.emplace_back(text); };
    return HeavyTopReference::load_or_build({}, t_end, ReferenceCache(directory_), message, margin);
  }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(directory_)) found.push_back(entry.path());
    return found;
  }

  std::filesystem::path directory_;
  std::vector<std::string> messages_;
};

TEST_F(HeavyTopReferenceCacheTest, ReadsBackEveryBit) {
  const HeavyTopReference built = load();
  ASSERT_EQ(files().size(), 1u);
  const auto written = std::filesystem::last_write_time(files()[0]);
  const HeavyTopReference loaded = load();
  EXPECT_EQ(std::filesystem::last_write_time(files()[0]), written);
  EXPECT_EQ(loaded.error_estimate(), built.error_estimate());
  EXPECT_EQ(loaded.method(), built.method());
  for (int i = 0; i <= 60; ++i) EXPECT_TRUE(identical(loaded.at(i * 0.001), built.at(i * 0.001)));
  EXPECT_THROW(loaded.at(0.0601), std::out_of_range);
  EXPECT_TRUE(messages_.empty());
}

TEST_F(HeavyTopReferenceCacheTest, TellsIntervalsApart) {
  load();
  load(0.04);
  load(0.05, 0.02);
  EXPECT_EQ(files().size(), 3u);
}

TEST_F(HeavyTopReferenceCacheTest, RebuildsADamagedFile) {
  const HeavyTopReference built = load();
  const std::filesystem::path file = files().at(0);
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(-100, std::ios::end);
  stream.put('\x55');
  stream.put('\x2a');
  stream.close();
  const HeavyTopReference rebuilt = load();
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_NE(messages_[0].find("damaged"), std::string::npos);
  EXPECT_TRUE(identical(rebuilt.at(0.05), built.at(0.05)));
  load();
  EXPECT_EQ(messages_.size(), 1u) << "the file is whole again";
}

}  // namespace
}  // namespace liebench
