// A binary file of little-endian uint16: a row a scan line, a column a beam.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "hardware/result.hpp"

namespace swivel {

class Uint16Rows {
 public:
  // Fails unless the file has exactly that size.
  static Result<Uint16Rows> open(const std::string& path, std::size_t rows, std::size_t beams);

  // The next row.
  Outcome read(std::vector<std::uint16_t>& row);

 private:
  Uint16Rows(std::string path, std::ifstream file, std::size_t beams);

  std::string path_;
  std::ifstream file_;
  std::vector<char> bytes_;  // of a row
};

}  // namespace swivel
