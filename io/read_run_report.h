#pragma once
// The report that a result carries, read back.

#include <string>

#include "io/run_report.h"

namespace clerestory {

/// What repeatable_text() wrote, but summaries of sensors. An empty text is an empty report.
///
/// file    for messages.
/// throws  InputError when the text is no such report.
RunReport run_report_of(const std::string& json, const std::string& file);

}  // namespace clerestory
