#include "problems/time_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "groups/extended.h"

namespace liebench::time_function_test {
namespace {

using Function = TimeFunction<double>;

std::string message_of(const std::string& expression) {
  try {
    Function::expression(expression);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(TimeFunction, ConstantIsOneWhereNothingIsSaid) {
  EXPECT_EQ(Function().at(3.0), 1.0);
  EXPECT_EQ(Function::constant(-2.5).at(3.0), -2.5);
}

TEST(TimeFunction, TableIsLinearInsideAndConstantOutside) {
  const Function f = Function::table({0.0, 1.0, 3.0}, {2.0, 4.0, -4.0});
  EXPECT_EQ(f.at(-1.0), 2.0);
  EXPECT_EQ(f.at(0.0), 2.0);
  EXPECT_EQ(f.at(0.5), 3.0);
  EXPECT_EQ(f.at(1.0), 4.0);
  EXPECT_EQ(f.at(2.0), 0.0);
  EXPECT_EQ(f.at(3.0), -4.0);
  EXPECT_EQ(f.at(9.0), -4.0);
  EXPECT_EQ(Function::table({1.0}, {7.0}).at(0.0), 7.0);
}

TEST(TimeFunction, TableThatIsNoneIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Function::table({}, {}), std::invalid_argument);
  EXPECT_THROW(Function::table({0.0, 1.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW(Function::table({0.0, 0.0}, {1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(Function::table({0.0, nan}, {1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(Function::table({0.0, 1.0}, {nan, 2.0}), std::invalid_argument);
}

TEST(TimeFunction, ExpressionOfTime) {
  const Function f = Function::expression("t < 1 ? sin(pi*t/2) : exp(1-t)");
  EXPECT_NEAR(f.at(0.5), std::sqrt(0.5), 2e-16);
  EXPECT_EQ(f.at(1.0), 1.0);
  EXPECT_NEAR(f.at(3.0), std::exp(-2.0), 2e-16);
}

TEST(TimeFunction, ExpressionThatIsNoneIsRefusedWithThePosition) {
  EXPECT_NE(message_of("1 + bad*t").find("(position 4)"), std::string::npos) << message_of("1 + bad*t");
  EXPECT_NE(message_of("1 + bad*t").find("bad"), std::string::npos);
  EXPECT_NE(message_of("sin(t"), "");
  EXPECT_NE(message_of(""), "");
  EXPECT_NE(message_of("1, t").find("2 values"), std::string::npos);
  EXPECT_NE(message_of("1/t").find("not finite"), std::string::npos);
}

TEST(TimeFunction, CopiesHaveParsersOfTheirOwn) {
  Function kept;
  {
    const Function first = Function::expression("2*t");
    kept = Function::constant(1.0);
    kept = first;
  }
  const Function copy = kept;
  kept = Function::expression("t^2");
  EXPECT_EQ(copy.at(3.0), 6.0);
  EXPECT_EQ(kept.at(3.0), 9.0);
}

TEST(TimeFunction, OneExpressionServesManyThreads) {
  const Function f = Function::expression("3*t + 1");
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < wrong.size(); ++k)
    threads.emplace_back([&, k] {
      for (int i = 0; i < 20000; ++i) wrong[k] += f.at(double(i + int(k))) != 3.0 * double(i + int(k)) + 1.0;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(TimeFunction, CastReadsDecimals) {
  const Extended third = Function::table({0.0, 0.3}, {0.0, 0.1}).cast<Extended>().at(Extended(0.1));
  EXPECT_LT(std::abs(to_double(third - Extended(0.1) / Extended(3.0))), 1e-31);
  const Extended tenth = Function::constant(0.1).cast<Extended>().at(Extended(0.0));
  EXPECT_LT(std::abs(to_double(tenth * Extended(10.0) - Extended(1.0))), 1e-31);
  EXPECT_EQ(to_double(Function::expression("t/4").cast<Extended>().at(Extended(3.0))), 0.75);
}

}  // namespace
}  // namespace liebench::time_function_test
