#pragma once
// Numbers as people read them.

#include <cstddef>
#include <string>

namespace clerestory {

/// 12345678 is "12,345,678".
std::string grouped(unsigned long long n);
/// "4.2", with so many significant digits; large and small values without exponent where that is short.
std::string rounded(double value, int digits = 3);
/// 0.0123 is "1.23 %".
std::string percent(double share);
/// "350 ms", "4.2 s", "3 min 20 s".
std::string duration(double seconds);
/// "210 MiB".
std::string bytes(std::size_t n);
/// "1 triangle", "2 triangles".
std::string counted(unsigned long long n, const std::string& thing);

}  // namespace clerestory
