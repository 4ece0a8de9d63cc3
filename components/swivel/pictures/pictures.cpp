#include "components/swivel/pictures/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "calibration/units.hpp"
#include "components/swivel/pictures/map_frame.hpp"
#include "components/swivel/pictures/paper.hpp"

namespace swivel {
namespace {

// The map's place on the paper.
constexpr int kMapSize = 1080;
constexpr int kMapLeft = 80;
constexpr int kMapTop = 80;
const cv::Rect kMapArea(kMapLeft, kMapTop, kMapSize, kMapSize);

// Paper with a map area.
class Sheet : public Paper {
 public:
  Sheet(const MapFrame& frame, const Colour& ground)
      : Paper(kPictureWidth_pixels, kPictureHeight_pixels),
        map_(pixels()(kMapArea)),
        frame_(frame) {
    map_ = ground;
  }

  cv::Mat& map() { return map_; }
  const MapFrame& frame() const { return frame_; }

  cv::Point on_paper(double x_m, double y_m) const {
    return {kMapLeft + static_cast<int>(std::lround(frame_.column_of(x_m))),
            kMapTop + static_cast<int>(std::lround(frame_.row_of(y_m)))};
  }

 private:
  cv::Mat map_;
  MapFrame frame_;
};

double grid_step_m(const MapFrame& frame) {
  const double across_m = frame.right_m() - frame.left_m();
  for (const double step_m : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0})
    if (across_m / step_m <= 12.0) return step_m;
  return 10.0;
}

// Lines of the grid from lowest to highest, each with its label.
template <class Draw>
void for_each_grid_line(double lowest_m, double highest_m, double step_m, Draw draw) {
  const auto last = static_cast<long>(std::floor(highest_m / step_m));
  for (auto line = static_cast<long>(std::ceil(lowest_m / step_m)); line <= last; ++line) {
    const double place_m = static_cast<double>(line) * step_m;
    draw(place_m, with_decimals(place_m, step_m < 1.0 ? 1 : 0));
  }
}

void draw_grid(Sheet& sheet, const Colour& colour) {
  const MapFrame& frame = sheet.frame();
  const double step_m = grid_step_m(frame);
  for_each_grid_line(frame.left_m(), frame.right_m(), step_m, [&](double x_m, const auto& label) {
    const int column = sheet.on_paper(x_m, 0.0).x;
    cv::line(sheet.pixels(), {column, kMapTop}, {column, kMapTop + kMapSize - 1}, colour);
    sheet.write(label, {column - sheet.width_of(label, 18) / 2, kMapTop + kMapSize + 24}, 18,
                kGrey);
  });
  for_each_grid_line(frame.bottom_m(), frame.top_m(), step_m, [&](double y_m, const auto& label) {
    const int row = sheet.on_paper(0.0, y_m).y;
    cv::line(sheet.pixels(), {kMapLeft, row}, {kMapLeft + kMapSize - 1, row}, colour);
    sheet.write(label, {kMapLeft - 10 - sheet.width_of(label, 18), row + 6}, 18, kGrey);
  });
}

void draw_points(Sheet& sheet, const OrganisedCloud& cloud, const HeightBand& band,
                 const Colour& colour) {
  for (const CloudPoint& point : cloud.points) {
    if (!band.holds(point)) continue;
    if (const auto pixel = sheet.frame().pixel_of(point)) {
      const cv::Rect dot(pixel->column, pixel->row, 2, 2);
      sheet.map()(dot & cv::Rect(0, 0, kMapSize, kMapSize)) = colour;
    }
  }
}

void draw_axes(Sheet& sheet, const std::string& name, const Colour& colour) {
  const cv::Point origin = sheet.on_paper(0.0, 0.0);
  constexpr int kLength = 70;
  cv::arrowedLine(sheet.pixels(), origin, origin + cv::Point(kLength, 0), colour, 2, cv::LINE_AA, 0,
                  0.2);
  cv::arrowedLine(sheet.pixels(), origin, origin - cv::Point(0, kLength), colour, 2, cv::LINE_AA, 0,
                  0.2);
  cv::circle(sheet.pixels(), origin, 5, colour, cv::FILLED, cv::LINE_AA);
  sheet.write("X", origin + cv::Point(kLength + 6, 7), 20, colour);
  sheet.write("Y", origin + cv::Point(-7, -kLength - 8), 20, colour);
  sheet.write(name, origin + cv::Point(10, 26), 20, colour);
}

void draw_scale_bar(Sheet& sheet, const Colour& colour) {
  const double length_m = grid_step_m(sheet.frame());
  const int length = static_cast<int>(std::lround(length_m * sheet.frame().pixels_per_m()));
  const cv::Point right(kMapLeft + kMapSize - 24, kMapTop + kMapSize - 24);
  const cv::Point left = right - cv::Point(length, 0);
  cv::line(sheet.pixels(), left, right, colour, 4);
  for (const cv::Point& end : {left, right})
    cv::line(sheet.pixels(), end - cv::Point(0, 8), end + cv::Point(0, 8), colour, 2);
  const std::string label = with_decimals(length_m, length_m < 1.0 ? 1 : 0) + " m";
  sheet.write(label, left + cv::Point((length - sheet.width_of(label, 20)) / 2, -14), 20, colour);
}

// The scan plane where the sweep began: the axis Y' of frame O', seen in frame O.
void draw_seam(Sheet& sheet, double phi_offset_rad) {
  const double far_m = 2.0 * kMapSize / sheet.frame().pixels_per_m();
  const double x_m = -std::sin(phi_offset_rad) * far_m, y_m = std::cos(phi_offset_rad) * far_m;
  cv::Point start = sheet.on_paper(x_m, y_m), end = sheet.on_paper(-x_m, -y_m);
  if (!cv::clipLine(kMapArea, start, end)) return;
  cv::line(sheet.pixels(), start, end, kOrange, 5, cv::LINE_AA);
}

std::string heights_in_words(const HeightBand& band) {
  const auto metres = [](float m) { return with_decimals(static_cast<double>(m), 2) + " m"; };
  const bool floor = !std::isinf(band.lowest_m), ceiling = !std::isinf(band.highest_m);
  if (floor && ceiling) return metres(band.lowest_m) + " to " + metres(band.highest_m);
  if (floor) return "above " + metres(band.lowest_m);
  return ceiling ? "below " + metres(band.highest_m) : "all";
}

void draw_caption(Sheet& sheet, const OrganisedCloud& cloud, const HeightBand& band,
                  const PictureCaption& caption) {
  const auto points = std::count_if(cloud.points.begin(), cloud.points.end(),
                                    [](const CloudPoint& point) { return point.valid(); });
  const auto shown = std::count_if(cloud.points.begin(), cloud.points.end(),
                                   [&](const CloudPoint& point) { return band.holds(point); });
  std::string sweep = "sweep " + std::to_string(caption.sweep);
  if (caption.mode != 0) sweep += "   mode " + std::to_string(caption.mode);
  sweep += "   " + std::to_string(cloud.lines) + " lines of " + std::to_string(cloud.beams) +
           " beams   " + std::to_string(points) + " points   verdict: " + caption.verdict;
  const std::string heights = "seen from above, metres; heights " + heights_in_words(band) + ": " +
                              std::to_string(shown) + " points shown";
  std::string turn = "swivel " SWIVEL_VERSION;
  if (caption.phi_offset_rad) {
    turn += "   phi_offset " + with_decimals(deg_from_rad(*caption.phi_offset_rad), 3) + " deg" +
            ", positive counter-clockwise seen from above (turns " + caption.frame + "' into " +
            caption.frame + ")";
  }
  sheet.write(caption.title, {kMapLeft, 36}, 26, kBlack);
  sheet.write(sweep, {kMapLeft, kMapTop + kMapSize + 66}, 19, kBlack);
  sheet.write(heights, {kMapLeft, kMapTop + kMapSize + 96}, 19, kGrey);
  sheet.write(turn, {kMapLeft, kMapTop + kMapSize + 126}, 19, kGrey);
}

}  // namespace

Outcome write_top_view(const std::string& path, const OrganisedCloud* before,
                       const OrganisedCloud& after, const PictureCaption& caption) {
  const HeightBand band = band_between_floor_and_ceiling(after);
  std::vector<const OrganisedCloud*> clouds{&after};
  if (before != nullptr) clouds.push_back(before);
  Sheet sheet(MapFrame(clouds, band, kMapSize, kMapSize), kWhite);
  draw_grid(sheet, kFaint);
  std::vector<LegendEntry> legend;
  if (before != nullptr) {
    draw_points(sheet, *before, band, kVermillion);
    legend.push_back({kVermillion, "before correction"});
  }
  if (caption.phi_offset_rad) draw_seam(sheet, *caption.phi_offset_rad);
  const Colour& colour = caption.uncorrected ? kVermillion : kBlue;
  draw_points(sheet, after, band, colour);
  legend.push_back({colour, caption.uncorrected ? "not corrected: attitude not known"
                            : before != nullptr ? "after correction"
                                                : "axis measured"});
  if (caption.phi_offset_rad) legend.push_back({kOrange, "seam: the sweep begins and ends here"});
  draw_axes(sheet, caption.frame, kBlack);
  draw_scale_bar(sheet, kBlack);
  sheet.write_legend(legend, {kMapLeft, 66});
  draw_caption(sheet, after, band, caption);
  return sheet.save(path);
}

namespace {

// A cell is a few pixels wide, so that counts are more than 0 and 1.
constexpr int kCell = 4;

cv::Mat count_points(const MapFrame& frame, const OrganisedCloud& cloud, const HeightBand& band) {
  cv::Mat counts = cv::Mat::zeros(kMapSize / kCell, kMapSize / kCell, CV_32F);
  for (const CloudPoint& point : cloud.points) {
    if (!band.holds(point)) continue;
    if (const auto pixel = frame.pixel_of(point))
      counts.at<float>(pixel->row / kCell, pixel->column / kCell) += 1.0F;
  }
  return counts;
}

// 0 to 255 on a logarithmic scale, 255 being `most`.
cv::Mat in_cividis(const cv::Mat& counts, double most) {
  cv::Mat logarithm, grey, colours;
  cv::log(counts + 1.0, logarithm);
  logarithm.convertTo(grey, CV_8U, 255.0 / std::log1p(most));
  cv::applyColorMap(grey, colours, cv::COLORMAP_CIVIDIS);
  return colours;
}

void draw_colour_bar(Sheet& sheet, double most) {
  constexpr int kLength = 400;
  cv::Mat counts(1, kLength, CV_32F);
  for (int place = 0; place < kLength; ++place)
    counts.at<float>(0, place) = static_cast<float>(std::expm1(place * std::log1p(most) / kLength));
  cv::Mat bar;
  cv::resize(in_cividis(counts, most), bar, {kLength, 18}, 0, 0, cv::INTER_NEAREST);
  bar.copyTo(sheet.pixels()(cv::Rect(kMapLeft, 48, kLength, 18)));
  const std::string words = "0 to " + with_decimals(most, 0) + " points a cell of " +
                            with_decimals(1e3 * kCell / sheet.frame().pixels_per_m(), 0) + " mm" +
                            ", logarithmic";
  sheet.write(words, {kMapLeft + kLength + 16, 64}, 19, kBlack);
}

}  // namespace

Outcome write_density_view(const std::string& path, const OrganisedCloud& cloud,
                           const PictureCaption& caption) {
  const HeightBand band = band_between_floor_and_ceiling(cloud);
  const MapFrame frame({&cloud}, band, kMapSize, kMapSize);
  Sheet sheet(frame, kBlack);
  const cv::Mat counts = count_points(frame, cloud, band);
  double most = 1.0;
  cv::minMaxLoc(counts, nullptr, &most);
  cv::Mat colours;
  cv::resize(in_cividis(counts, std::max(most, 1.0)), colours, {kMapSize, kMapSize}, 0, 0,
             cv::INTER_NEAREST);
  colours.copyTo(sheet.map());
  draw_grid(sheet, Colour(96, 64, 24));
  draw_axes(sheet, caption.frame, kWhite);
  draw_scale_bar(sheet, kWhite);
  draw_colour_bar(sheet, std::max(most, 1.0));
  draw_caption(sheet, cloud, band, caption);
  return sheet.save(path);
}

}  // namespace swivel
