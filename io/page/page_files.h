#pragma once
// What a page is made with that is no C++: its style and its viewer, beside the program in share/clerestory/page.

#include <string>

namespace clerestory {

struct PageFiles {
  std::string style;           ///< CSS
  std::string viewer;          ///< JavaScript with three.js in it; empty: it was not there to build with
  std::string viewer_licence;  ///< of three.js, as its makers want it kept
  std::string why_no_viewer;   ///< what to do about it
};

/// throws  InputError when the style is missing: the program is not installed whole.
PageFiles read_page_files();

}  // namespace clerestory
