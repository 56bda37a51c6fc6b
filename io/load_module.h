#pragma once
// Modules: parts of the program that bring many libraries along, loaded when they are wanted.

namespace clerestory {

/// A function of a module, null when the module, or what it needs, is not installed. A module stays loaded.
void* module_function(const char* module, const char* symbol);

}  // namespace clerestory
