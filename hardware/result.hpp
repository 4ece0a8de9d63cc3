// What can fail in operation returns a Result: the value, or the reason in words that tell
// the user what is wrong and what to do.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>

namespace swivel {

struct Failure {
  std::string reason;
};

template <class Value>
class Result {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): so that a function returns value or failure
  Result(Value value) : value_(std::move(value)) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  Result(Failure failure) : reason_(std::move(failure.reason)) {}

  explicit operator bool() const { return value_.has_value(); }
  Value& operator*() { return assert(value_), *value_; }
  const Value& operator*() const { return assert(value_), *value_; }
  Value* operator->() { return &**this; }
  const Value* operator->() const { return &**this; }
  const std::string& reason() const { return reason_; }

 private:
  std::optional<Value> value_;
  std::string reason_;
};

struct Done {};
using Outcome = Result<Done>;  // of what returns nothing but may fail

}  // namespace swivel
