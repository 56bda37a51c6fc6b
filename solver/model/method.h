#pragma once
// The methods, accuracies and oracles there are, by the names that users type.

#include <string_view>

namespace clerestory {

enum class Method { hierarchical, progressive, gauss_seidel, jacobi, path, bidirectional, particles };
enum class Accuracy { draft, standard, fine };
/// By what the hierarchical method decides which elements to halve and where to link. error: by how much light varies
/// inside of them, told by rays. bf: by the flux at stake on a link, rho_p F_pq B_q A_p, as the classic method has it.
enum class Oracle { error, bf };

/// Whether the method makes the matrix of all form factors.
constexpr bool has_matrix(Method m) { return m == Method::gauss_seidel || m == Method::jacobi; }

/// Whether it traces paths from every point, and knows no elements.
constexpr bool is_by_paths(Method m) { return m == Method::path || m == Method::bidirectional; }

/// In the order of the enumerators.
inline constexpr std::string_view kMethodNames[] = {"hierarchical", "progressive",   "gauss-seidel", "jacobi",
                                                    "path",         "bidirectional", "particles"};
inline constexpr std::string_view kAccuracyNames[] = {"draft", "standard", "fine"};
inline constexpr std::string_view kOracleNames[] = {"error", "bf"};

}  // namespace clerestory
