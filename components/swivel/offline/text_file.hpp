// Files and folders for a user: written, or the program ends with what to do.
#pragma once

#include <string>

#include "hardware/result.hpp"

namespace swivel {

// It appears under its name only when it is whole. Throws ExitError (kExitInputOutput).
void write_text_file(const std::string& path, const std::string& text);

// Of what writes files itself. Throws ExitError (kExitInputOutput) with the reason if it could not.
void require_written(const Outcome& outcome);

// Makes the folder and those above it. Throws ExitError (kExitCannotWrite).
void make_folder(const std::string& path);

}  // namespace swivel
