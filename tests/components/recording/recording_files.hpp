// Copies of the recordings in tests/data, to be read by other means than the reader's, and to be
// spoilt.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace swivel {

inline std::string test_recording(const std::string& name) {
  return std::string(SWIVEL_TEST_DATA) + "/recordings/" + name;
}

inline std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

inline void write_file(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

inline std::string unzipped(const std::string& path) {
  std::string content;
  char piece[4096];
  gzFile file = gzopen(path.c_str(), "rb");
  while (const int length = gzread(file, piece, sizeof piece)) {
    if (length < 0) break;
    content.append(piece, static_cast<std::size_t>(length));
  }
  gzclose(file);
  return content;
}

inline std::vector<std::string> lines_of(const std::string& content) {
  std::vector<std::string> lines;
  std::istringstream stream(content);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string content;
  for (const std::string& line : lines) content += line + "\n";
  return content;
}

// A folder that is gone when the test is.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = testing::TempDir() + "swivel_recording_XXXXXX";
    path_ = mkdtemp(pattern.data());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  void copy_case(const std::string& name) const {
    std::filesystem::copy(test_recording(name), path_);
  }

 private:
  std::string path_;
};

}  // namespace swivel
