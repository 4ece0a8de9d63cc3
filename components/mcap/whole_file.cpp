#include "components/mcap/whole_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "components/mcap/bytes.hpp"

namespace swivel {
namespace {

constexpr std::uint64_t kDataEndSize = 13;
constexpr std::uint64_t kFooterRecordSize = 29;
constexpr std::size_t kBlock = 1 << 20;

// Bytes of the file, a part at a time; `part` takes each.
template <class Part>
bool read(std::ifstream& file, std::uint64_t start, std::uint64_t end, Part part) {
  std::string block;
  file.seekg(static_cast<std::streamoff>(start));
  while (start < end) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, end - start)));
    if (!file.read(block.data(), static_cast<std::streamsize>(block.size()))) return false;
    part(block);
    start += block.size();
  }
  return true;
}

std::string bytes_at(std::ifstream& file, std::uint64_t start, std::uint64_t size) {
  std::string all;
  read(file, start, start + size, [&](const std::string& block) { all += block; });
  return all;
}

std::uint32_t sum(std::ifstream& file, std::uint64_t start, std::uint64_t end) {
  std::uint32_t crc = 0;
  read(file, start, end, [&](const std::string& block) { crc = mcap_crc(block, crc); });
  return crc;
}

}  // namespace

Outcome check_file_sums(const std::string& path) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t tail = kFooterRecordSize + kMcapMagic.size();
  if (error || !file) return Failure{path + ": cannot be opened"};
  if (size < tail + kDataEndSize) return Failure{path + ": it was cut"};
  const std::string end = bytes_at(file, size - tail, tail);
  McapDecoder footer(std::string_view(end).substr(9));
  const std::uint64_t summary_start = footer.u64();
  footer.u64();
  const std::uint32_t summary_crc = footer.u32();
  if (footer.rest() != kMcapMagic || summary_start > size - tail || summary_start < kDataEndSize) {
    return Failure{path + ": it has no end, or no summary: it was cut, or never closed"};
  }
  const std::uint64_t data_end = summary_start - kDataEndSize;
  const std::string data_crc = bytes_at(file, data_end + 9, 4);
  if (sum(file, 0, data_end) != McapDecoder(data_crc).u32()) {
    return Failure{path + ": the sum over its data is wrong: some byte was changed"};
  }
  if (sum(file, summary_start, size - kMcapMagic.size() - 4) != summary_crc) {
    return Failure{path + ": the sum over its summary is wrong: some byte was changed"};
  }
  return Done{};
}

}  // namespace swivel
