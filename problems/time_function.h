#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "groups/decimal.h"
#include "groups/scalar.h"
#include "problems/expression.h"

namespace liebench {

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
