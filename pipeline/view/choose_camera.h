#pragma once
// Request -> camera.

#include <filesystem>

#include "pipeline/view/view_request.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// What is shown of a result, by number: all; of drawings, where there are rooms, only what is in those, so that one
/// looks into them and not onto a roof, and an automatic scale is of them.
std::vector<std::uint32_t> shown_triangles(const WrittenResult& result, const ViewRequest& request);

/// result  read from `file`; its model is looked for where it was when it was solved, then beside `file`.
/// throws  InputError when there is no such camera, its model is gone, eye and target are one, or nothing lies behind
///         the cut.
Camera choose_camera(const WrittenResult& result, const std::filesystem::path& file, const ViewRequest& request);

}  // namespace clerestory
