#pragma once
// The methods and accuracies there are, by the names that users type.

#include <string_view>

namespace clerestory {

enum class Method { hierarchical, progressive, gauss_seidel, jacobi, path };
enum class Accuracy { draft, standard, fine };

/// In the order of the enumerators.
inline constexpr std::string_view kMethodNames[] = {"hierarchical", "progressive", "gauss-seidel", "jacobi", "path"};
inline constexpr std::string_view kAccuracyNames[] = {"draft", "standard", "fine"};

}  // namespace clerestory
