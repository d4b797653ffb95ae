#pragma once

#include <muParser.h>

#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

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
    // muParser takes "t = 1" for an assignment whose value is 1.
    for (std::size_t i = 0; i < text_.size(); ++i) {
      const auto is = [&](std::size_t j, const char* characters) {
        return j < text_.size() && std::string(characters).find(text_[j]) != std::string::npos;
      };
      if (text_[i] != '=') continue;
      if (is(i + 1, "=")) {
        ++i;
      } else if (i == 0 || !is(i - 1, "<>!")) {
        refuse("assigns; \"==\" compares (position " + std::to_string(i) + ")");
      }
    }
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

}  // namespace liebench
