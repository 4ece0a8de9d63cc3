#include "components/recording/gzip_lines.hpp"

#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <utility>

namespace swivel {
namespace {

// A line of 20 000 beams with intensities has 260 000 characters.
constexpr std::size_t kLongestLine = 1 << 19;
constexpr unsigned kReadAhead = 1 << 16;

}  // namespace

void GzipLines::Closer::operator()(gzFile_s* file) const {
  gzclose_r(file);
}

GzipLines::GzipLines(std::string path, File file)
    : path_(std::move(path)), file_(std::move(file)), text_(kLongestLine) {}

Result<GzipLines> GzipLines::open(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return Failure{path + ": there is no such file"};
  File file(gzopen(path.c_str(), "rb"));
  if (!file) return Failure{path + ": cannot be opened: " + std::strerror(errno)};
  gzbuffer(file.get(), kReadAhead);
  return GzipLines(path, std::move(file));
}

Result<std::optional<std::string_view>> GzipLines::next() {
  ++line_number_;
  const char* const line = gzgets(file_.get(), text_.data(), static_cast<int>(text_.size()));
  int error = Z_OK;
  const char* const words = gzerror(file_.get(), &error);
  if (error != Z_OK && error != Z_STREAM_END)
    return failure(std::string("the file is cut or damaged here (") + words + "); copy it again");
  if (line == nullptr) return std::optional<std::string_view>();

  std::string_view text(line);
  const bool ended = !text.empty() && text.back() == '\n';
  if (!ended && gzeof(file_.get()) == 0)
    return failure("the line is too long or has a zero byte; this is no recording");
  if (!ended) return failure("the last line has no end: the file is cut; copy it again");
  text.remove_suffix(1);
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return std::optional<std::string_view>(text);
}

Failure GzipLines::failure(const std::string& reason) const {
  return Failure{path_ + ":" + std::to_string(line_number_) + ": " + reason};
}

}  // namespace swivel
