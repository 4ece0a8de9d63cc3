// White paper to draw a picture on, with letters and the colours of all pictures. Colours after
// Okabe and Ito: told apart by the colour-blind as well.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/freetype.hpp>
#include <string>
#include <vector>

#include "hardware/result.hpp"

namespace swivel {

using Colour = cv::Scalar;  // blue, green, red

inline const Colour kWhite(255, 255, 255), kBlack(0, 0, 0), kGrey(110, 110, 110),
    kFaint(228, 228, 228);
inline const Colour kVermillion(0, 94, 213), kBlue(178, 114, 0), kOrange(0, 159, 230),
    kSkyBlue(233, 180, 86);

// A number as it is printed.
std::string with_decimals(double value, int decimals);

struct LegendEntry {
  Colour colour;
  std::string words;
};

class Paper {
 public:
  Paper(int width_pixels, int height_pixels);

  cv::Mat& pixels() { return pixels_; }

  // left_base: where the text's base line begins.
  void write(const std::string& text, cv::Point left_base, int size, const Colour& colour);
  void write_centred(const std::string& text, cv::Point middle_base, int size,
                     const Colour& colour);
  int width_of(const std::string& text, int size);

  // In one row from there on.
  void write_legend(const std::vector<LegendEntry>& entries, cv::Point left_base);

  Outcome save(const std::string& path) const;

 private:
  cv::Mat pixels_;
  cv::Ptr<cv::freetype::FreeType2> letters_;  // null without a font file
};

}  // namespace swivel
