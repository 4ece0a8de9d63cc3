// Holes in the sequence numbers of one writer.
#pragma once

#include <cstdint>
#include <optional>

namespace swivel {

class SequenceCount {
 public:
  // The first may have any number: who comes late has not lost what was before.
  void add(std::uint32_t number) {
    // Numbers wrap around; what is half of them ahead stands behind.
    const std::uint32_t ahead = last_ ? number - *last_ : 1;
    if (ahead == 0 || ahead > UINT32_MAX / 2) {
      ++repeated_;
      return;
    }
    missing_ += ahead - 1;
    last_ = number;
  }

  std::uint64_t missing() const { return missing_; }
  std::uint64_t repeated() const { return repeated_; }  // or out of order

 private:
  std::optional<std::uint32_t> last_;
  std::uint64_t missing_ = 0;
  std::uint64_t repeated_ = 0;
};

}  // namespace swivel
