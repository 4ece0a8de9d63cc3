// A text file that appears under its name only when it is whole.
#pragma once

#include <string>

namespace swivel {

// Throws ExitError (kExitInputOutput) with what to do.
void write_text_file(const std::string& path, const std::string& text);

// Makes the folder and those above it. Throws ExitError (kExitCannotWrite).
void make_folder(const std::string& path);

}  // namespace swivel
