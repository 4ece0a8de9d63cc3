#include "components/swivel/pictures/paper.hpp"

#include <filesystem>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

namespace swivel {
namespace {

// DejaVu and Liberation as Debian, Fedora and Arch place them.
const char* const kFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                              "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                              "/usr/share/fonts/TTF/DejaVuSans.ttf",
                              "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};

}  // namespace

std::string with_decimals(double value, int decimals) {
  std::ostringstream words;
  words << std::fixed << std::setprecision(decimals) << value;
  return words.str();
}

Paper::Paper(int width_pixels, int height_pixels)
    : pixels_(height_pixels, width_pixels, CV_8UC3, kWhite) {
  for (const char* font : kFonts) {
    if (!std::filesystem::exists(font)) continue;
    letters_ = cv::freetype::createFreeType2();
    letters_->loadFontData(font, 0);
    break;
  }
}

// Without a font file OpenCV's own strokes must do.
void Paper::write(const std::string& text, cv::Point left_base, int size, const Colour& colour) {
  if (letters_) {
    letters_->putText(pixels_, text, left_base, size, colour, cv::FILLED, cv::LINE_AA, true);
  } else {
    cv::putText(pixels_, text, left_base, cv::FONT_HERSHEY_SIMPLEX, size / 30.0, colour, 1,
                cv::LINE_AA);
  }
}

void Paper::write_centred(const std::string& text, cv::Point middle_base, int size,
                          const Colour& colour) {
  write(text, middle_base - cv::Point(width_of(text, size) / 2, 0), size, colour);
}

int Paper::width_of(const std::string& text, int size) {
  int below = 0;
  if (letters_) return letters_->getTextSize(text, size, cv::FILLED, &below).width;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size / 30.0, 1, &below).width;
}

void Paper::write_legend(const std::vector<LegendEntry>& entries, cv::Point left_base) {
  int column = left_base.x;
  for (const LegendEntry& entry : entries) {
    cv::rectangle(pixels_, {column, left_base.y - 16, 18, 18}, entry.colour, cv::FILLED);
    write(entry.words, {column + 26, left_base.y}, 19, kBlack);
    column += 26 + width_of(entry.words, 19) + 36;
  }
}

Outcome Paper::save(const std::string& path) const {
  try {
    if (cv::imwrite(path, pixels_)) return Done{};
  } catch (const cv::Exception&) {  // the same failure, said in another way
  }
  return Failure{path + ": cannot be written; is the folder there, and the disk not full?"};
}

}  // namespace swivel
