#include "components/swivel/offline/text_file.hpp"

#include <filesystem>
#include <fstream>

#include "components/common/program.hpp"

namespace swivel {

void write_text_file(const std::string& path, const std::string& text) {
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (file && !error) return;
  std::filesystem::remove(part, error);
  throw ExitError(kExitInputOutput, path + ": cannot be written; is the disk full?");
}

void require_written(const Outcome& outcome) {
  if (!outcome) throw ExitError(kExitInputOutput, outcome.reason());
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!std::filesystem::is_directory(path, error))
    throw ExitError(kExitCannotWrite, path + ": the folder cannot be made; choose another with -o");
}

}  // namespace swivel
