#pragma once
// What ifc/read_ifc.mjs answers: records of 4 bytes tag, 4 of nothing, 8 of length, and the bytes, after "CLIFC001".
//
//   1  the name of the product that is in work
//
//   2  mesh: surface, material, n vertices, m corners (4 bytes each), 3 x 4 numbers to metres (8 each), 3 n floats (4),
//      m corners (4)
//
//   3  mesh of a space: the same, with the space for the surface
//
//   4  the end: JSON of all else, or {"refused": why}
//
// Numbers are little-endian.

#include <string>
#include <string_view>

#include "io/formats/model.h"

namespace clerestory {

/// Model of a whole answer. Every count is checked against the bytes and every index against what it counts.
///
/// file     the IFC file, beside which a photometric file may lie; its name begins messages.
/// throws   InputError when the file was refused, or has more faces than are read; std::runtime_error when the answer
///          is not of this form or has no end.
Model model_of_ifc_answer(std::string_view answer, const std::filesystem::path& file);

/// The product that was in work when the answer ended; empty when there was none.
std::string last_ifc_product(std::string_view answer);

}  // namespace clerestory
