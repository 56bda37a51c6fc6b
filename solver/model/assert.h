#pragma once
// Our own mistakes, stopped where they arise. What users give is checked always, and throws InputError.

#include <cstdlib>
#include <iostream>

// CLERESTORY_ASSERT(a, <=, b) ends the program with file, line, the text and the values of both sides when it does not
// hold. In debug builds, and with sanitizers; nothing is evaluated otherwise.
#if !defined(NDEBUG) || defined(CLERESTORY_ASSERTS)
#define CLERESTORY_ASSERT(left, op, right)                                                                             \
  do {                                                                                                                 \
    const auto& clerestory_left = (left);                                                                              \
    const auto& clerestory_right = (right);                                                                            \
    if (!(clerestory_left op clerestory_right))                                                                        \
      ::clerestory::assertion_failed(__FILE__, __LINE__, #left " " #op " " #right, clerestory_left, clerestory_right); \
  } while (false)
#else
#define CLERESTORY_ASSERT(left, op, right) static_cast<void>(0)
#endif

namespace clerestory {

template <class Left, class Right>
[[noreturn]] void assertion_failed(const char* file, int line, const char* text, const Left& left, const Right& right) {
  std::cerr << file << ":" << line << ": " << text << " does not hold: " << left << " and " << right << std::endl;
  std::abort();
}

}  // namespace clerestory
