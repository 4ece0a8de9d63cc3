#include "components/recording/uint16_rows.hpp"

#include <filesystem>
#include <utility>

namespace swivel {

Result<Uint16Rows> Uint16Rows::open(const std::string& path, std::size_t rows, std::size_t beams) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) return Failure{path + ": there is no such file"};
  const std::size_t expected = rows * beams * 2;
  if (bytes != expected) {
    return Failure{path + ": has " + std::to_string(bytes) + " bytes; " + std::to_string(rows) +
                   " lines of " + std::to_string(beams) + " beams need " +
                   std::to_string(expected) + "; copy it again"};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return Failure{path + ": cannot be opened; check its permissions"};
  return Uint16Rows(path, std::move(file), beams);
}

Uint16Rows::Uint16Rows(std::string path, std::ifstream file, std::size_t beams)
    : path_(std::move(path)), file_(std::move(file)), bytes_(beams * 2) {}

Outcome Uint16Rows::read(std::vector<std::uint16_t>& row) {
  if (!file_.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size())))
    return Failure{path_ + ": became shorter while it was read"};
  row.resize(bytes_.size() / 2);
  for (std::size_t beam = 0; beam < row.size(); ++beam) {
    const auto low = static_cast<unsigned char>(bytes_[2 * beam]);
    const auto high = static_cast<unsigned char>(bytes_[2 * beam + 1]);
    row[beam] = static_cast<std::uint16_t>(low | (high << 8));
  }
  return Done{};
}

}  // namespace swivel
