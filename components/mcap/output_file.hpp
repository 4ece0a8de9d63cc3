// A file that grows as NAME.part and gets its name when it is whole.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hardware/result.hpp"

namespace swivel {

class OutputFile {
 public:
  // Fails where NAME or NAME.part is already there: neither is written over.
  static Result<OutputFile> create(const std::string& name);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();  // what is not finished stays as NAME.part

  Outcome append(std::string_view bytes);  // after one that failed all fail
  Outcome sync();                          // returns once the disk has it
  Outcome finish();                        // syncs, closes, renames

  std::uint64_t size() const { return size_; }
  std::uint32_t crc() const { return crc_; }  // of all bytes so far
  const std::string& name() const { return name_; }

 private:
  OutputFile(std::string name, int descriptor) : name_(std::move(name)), descriptor_(descriptor) {}
  Failure failure(const std::string& what) const;

  std::string name_;
  int descriptor_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;
  bool broken_ = false;
};

// Where a file is until it is finished.
std::string part_of(const std::string& name);

}  // namespace swivel
