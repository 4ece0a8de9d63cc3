#include "hardware/sim/grbl_settings.hpp"

#include <cmath>
#include <cstdio>

namespace swivel::sim {
namespace {

constexpr int kFirstAxisSetting = 100;

std::string formatted(int number, double value) {
  const bool decimals = number >= kFirstAxisSetting || number == 11 || number == 12 ||
                        number == 24 || number == 25 || number == 27;
  char text[64];
  std::snprintf(text, sizeof text, "$%d=%.*f\r\n", number, decimals ? 3 : 0, value);
  return text;
}

}  // namespace

GrblSettings::GrblSettings(double travel_deg)
    : values_{{0, 10},    {1, 255},          {2, 0},     {3, 0},      {4, 0},        {5, 0},
              {6, 0},     {10, 1},           {11, 0.01}, {12, 0.002}, {13, 0},       {20, 0},
              {21, 0},    {22, 1},           {23, 1},    {24, 60},    {25, 5400},    {26, 25},
              {27, 1},    {30, 1000},        {31, 0},    {32, 0},     {100, 88.889}, {101, 250},
              {102, 250}, {110, 12000},      {111, 500}, {112, 500},  {120, 720},    {121, 10},
              {122, 10},  {130, travel_deg}, {131, 200}, {132, 200}} {}

bool GrblSettings::set(int number, double value) {
  if (!knows(number) || !std::isfinite(value) || value < 0.0 || value > 1e7) return false;
  if (number >= 100 && number <= 102 && value > 1e4) return false;
  const bool rate = (number >= 100 && number <= 132) || number == 24 || number == 25;
  if (rate && value < 1e-3) return false;
  values_[number] = value;
  return true;
}

std::string GrblSettings::listing() const {
  std::string lines;
  for (const auto& [number, value] : values_) lines += formatted(number, value);
  return lines;
}

double GrblSettings::homed_position_deg() const {
  const bool negative_end = (static_cast<int>(values_.at(23)) & 1) != 0;
  return negative_end ? pull_off_deg() - travel_deg() : -pull_off_deg();
}

}  // namespace swivel::sim
