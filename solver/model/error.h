#pragma once
// Refused input. Anything else that goes wrong is our own fault and an ordinary exception.

#include <stdexcept>
#include <string>

namespace clerestory {

/// Input that cannot be used. The message names file, place, value, the allowed range and what to do.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked for an end before there was anything to show.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace clerestory
