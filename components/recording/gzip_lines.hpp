// The lines of a text file, gzipped or plain, one by one; a line is bounded in length.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/result.hpp"

struct gzFile_s;

namespace swivel {

class GzipLines {
 public:
  static Result<GzipLines> open(const std::string& path);

  // The next line without its end, valid until the next call; nothing at the end of the file.
  // Fails on a cut or damaged file, a line without end, a zero byte.
  Result<std::optional<std::string_view>> next();

  // A failure at the line read last: "FILE:LINE: reason".
  Failure failure(const std::string& reason) const;

 private:
  struct Closer {
    void operator()(gzFile_s* file) const;
  };
  using File = std::unique_ptr<gzFile_s, Closer>;

  GzipLines(std::string path, File file);

  std::string path_;
  File file_;
  std::vector<char> text_;
  std::size_t line_number_ = 0;
};

}  // namespace swivel
