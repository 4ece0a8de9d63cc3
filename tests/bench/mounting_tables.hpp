// ./run bench accuracy --mounting: the errors of bias and mounting, beside what is to be reached.
#pragma once

#include <cstdint>

namespace swivel {

void print_mounting_accuracy(int rigs, std::uint64_t seed);

}  // namespace swivel
