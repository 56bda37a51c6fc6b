#pragma once
// Lists that stay short in messages.

#include <cstddef>
#include <sstream>
#include <string>

namespace clerestory {

/// "a, b, c and 3 more": word(item) of the first `most`.
template <class Items, class Word>
std::string some_of(const Items& items, std::size_t most, const Word& word) {
  std::ostringstream out;
  for (std::size_t k = 0; k < items.size() && k < most; ++k) out << (k > 0 ? ", " : "") << word(items[k]);
  if (items.size() > most) out << " and " << items.size() - most << " more";
  return out.str();
}

}  // namespace clerestory
