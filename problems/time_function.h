#pragma once

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "groups/decimal.h"
#include "groups/scalar.h"

namespace liebench {

// A mathematical expression of the time t [s], evaluated in double by muParser: its operators and functions (sin, exp, sqrt, ...,
// "t < 1 ? t : 1"), and pi. Every object has a parser of its own, which one thread at a time uses.
class Expression {
 public:
  // Throws std::invalid_argument, with the parser's message and the position, where the text is no expression of t with one
  // value, or where this is not finite at t = 0.
  explicit Expression(const std::string& text) : text_(text) {
    parser_.DefineConst("pi", std::acos(-1.0));
    parser_.DefineVar("t", &t_);
    parse();
  }
  Expression(const Expression& other) : Expression(other.text_) {}
  Expression& operator=(const Expression& other) {
    text_ = other.text_;
    parse();
    return *this;
  }

  const std::string& text() const { return text_; }
  double at(double t) const {
    const std::lock_guard lock(one_at_a_time_);
    t_ = t;
    return parser_.Eval();
  }

 private:
  void parse() {
    const auto refuse = [&](const std::string& why) {
      throw std::invalid_argument("expression '" + text_ + "': " + why);
    };
    try {
      t_ = 0.0;
      parser_.SetExpr(text_);
      int values = 0;
      const double value = parser_.Eval(values)[0];
      if (values != 1) refuse("has " + std::to_string(values) + " values");
      if (!std::isfinite(value)) refuse("is not finite at t = 0");
    } catch (const mu::ParserError& error) {
      refuse(error.GetMsg() + " (position " + std::to_string(error.GetPos()) + ")");
    }
  }

  std::string text_;
  mutable std::mutex one_at_a_time_;
  mutable double t_ = 0.0;
  mu::Parser parser_;
};

// A factor as a function of time: a constant, a table or an expression. 1 where nothing is said.
template <class T>
class TimeFunction {
 public:
  TimeFunction() = default;
  static TimeFunction constant(const T& value) { return TimeFunction(value); }
  // Linear between its points, constant before the first and after the last. Throws std::invalid_argument without points, where
  // times and values differ in number, where a number is not finite, and where times do not increase strictly.
  static TimeFunction table(const std::vector<T>& times, const std::vector<T>& values) {
    if (times.empty() || times.size() != values.size())
      throw std::invalid_argument("table: " + std::to_string(times.size()) + " times and " +
                                  std::to_string(values.size()) + " values");
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!std::isfinite(to_double(times[i])) || !std::isfinite(to_double(values[i])))
        throw std::invalid_argument("table: not finite at index " + std::to_string(i));
      if (i > 0 && !(times[i - 1] < times[i]))
        throw std::invalid_argument("table: times do not increase at index " + std::to_string(i));
    }
    return TimeFunction(Table{times, values});
  }
  // See Expression.
  static TimeFunction expression(const std::string& text) { return TimeFunction(Expression(text)); }

  T at(const T& t) const {
    if (const T* value = std::get_if<T>(&function_)) return *value;
    if (const Table* table = std::get_if<Table>(&function_)) return table->at(t);
    return T(std::get<Expression>(function_).at(to_double(t)));
  }

  template <class U>
  TimeFunction<U> cast() const {
    if (const T* value = std::get_if<T>(&function_)) return TimeFunction<U>::constant(decimal<U>(*value));
    if (const Table* table = std::get_if<Table>(&function_))
      return TimeFunction<U>::table(in_scalar<U>(table->times), in_scalar<U>(table->values));
    return TimeFunction<U>::expression(std::get<Expression>(function_).text());
  }

 private:
  struct Table {
    std::vector<T> times, values;
    T at(const T& t) const {
      const auto after = std::upper_bound(times.begin(), times.end(), t);
      if (after == times.begin()) return values.front();
      if (after == times.end()) return values.back();
      const std::size_t i = std::size_t(after - times.begin());
      const T part = (t - times[i - 1]) / (times[i] - times[i - 1]);
      return values[i - 1] + part * (values[i] - values[i - 1]);
    }
  };
  template <class F>
  explicit TimeFunction(const F& function) : function_(function) {}
  template <class U>
  static std::vector<U> in_scalar(const std::vector<T>& numbers) {
    std::vector<U> result;
    for (const T& x : numbers) result.push_back(decimal<U>(x));
    return result;
  }

  std::variant<T, Table, Expression> function_ = T(1.0);
};

}  // namespace liebench
