#pragma once
// Result -> picture: the middle of `clerestory render`.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/observer.h"
#include "pipeline/view/view_request.h"
#include "solver/model/monitor.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// The bytes of the file, and what is said of it.
struct RenderedView {
  std::string bytes;               ///< empty: interrupted
  int width = 0, height = 0;       ///< of the picture, the legend included [pixel]
  std::vector<std::string> notes;  ///< "exposure ...", "range ..."
};

/// throws  InputError when an array or camera is not there, or there is nothing to see; before any ray is sent.
/// as_exr  the numbers themselves, else a PNG.
RenderedView render_view(const WrittenResult& result, const std::filesystem::path& file, const ViewRequest& request,
                         bool as_exr, Observer& observer, const Monitor& monitor);

}  // namespace clerestory
