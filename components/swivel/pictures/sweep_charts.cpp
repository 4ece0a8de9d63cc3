#include "components/swivel/pictures/sweep_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "calibration/units.hpp"
#include "components/swivel/pictures/chart.hpp"
#include "components/swivel/pictures/map_frame.hpp"
#include "components/swivel/report/evaluation.hpp"

namespace swivel {
namespace {

constexpr int kSheetWidth = 1200;
constexpr int kSheetLeft = 90;

const Colour kPaleBand(242, 242, 242);

std::string sweep_words(const PictureCaption& caption) {
  std::string words = "sweep " + std::to_string(caption.sweep);
  if (caption.mode != 0) words += ", mode " + std::to_string(caption.mode);
  return words + ", " + caption.verdict + ", frame " + caption.frame;
}

void head(Paper& paper, const std::string& what, const PictureCaption& caption) {
  paper.write(caption.title + ": " + what, {kSheetLeft, 36}, 26, kBlack);
  paper.write(sweep_words(caption), {kSheetLeft, 66}, 18, kGrey);
}

// Means of what belongs together, drawn as one line where it lies side by side.
class Means {
 public:
  void add(long group, double place, double value) {
    Sum& sum = sums_[group];
    sum.place += place;
    sum.value += value;
    sum.count += 1.0;
  }

  void draw(Chart& chart, const Colour& colour) const {
    const Sum* before = nullptr;
    long group_before = 0;
    for (const auto& [group, sum] : sums_) {
      if (sum.count < kLeastPoints) continue;
      if (before != nullptr && group - group_before <= 2)
        chart.line(before->place / before->count, before->value / before->count,
                   sum.place / sum.count, sum.value / sum.count, colour, 3);
      chart.dot(sum.place / sum.count, sum.value / sum.count, colour, 2);
      before = &sum;
      group_before = group;
    }
  }

 private:
  static constexpr double kLeastPoints = 8.0;
  struct Sum {
    double place = 0.0;
    double value = 0.0;
    double count = 0.0;
  };
  std::map<long, Sum> sums_;
};

using Place = double SurfacePoint::*;

// The middle 99.8 %.
Span extent_of(const Surface& surface, Place place) {
  std::vector<double> places;
  places.reserve(surface.points.size());
  for (const SurfacePoint& point : surface.points) places.push_back(point.*place);
  if (places.empty()) return {-1.0, 1.0};
  std::sort(places.begin(), places.end());
  const std::size_t strays = places.size() / 1000;
  const Span span{places[strays], places[places.size() - 1 - strays]};
  const double room = 0.03 * (span.highest - span.lowest) + 0.01;
  return {span.lowest - room, span.highest + room};
}

constexpr double kShownOff_mm = 80.0;

enum class MeanOf { kLine, kPlace };

// Points off the plane over a place on it; dark the mean of each scan line, or of each 0.1 m.
void draw_profile(Chart& chart, const Surface& surface, Place place, MeanOf mean_of,
                  const std::string& name) {
  constexpr std::size_t kMostSpecks = 5000;  // more say no more
  const double band_mm = mm_from_m(kLidarBand_m);
  chart.band(-band_mm, band_mm, kPaleBand);
  chart.draw_axes(name, "off the plane, mm");
  const std::size_t stride = 1 + surface.points.size() / kMostSpecks;
  Means means;
  for (std::size_t index = 0; index < surface.points.size(); ++index) {
    const SurfacePoint& point = surface.points[index];
    if (index % stride == 0) chart.speck(point.*place, mm_from_m(point.off_m), kSkyBlue);
    const long group =
        mean_of == MeanOf::kLine ? static_cast<long>(point.line) : std::lround(point.*place / 0.1);
    means.add(group, point.*place, mm_from_m(point.off_m));
  }
  const Span span = extent_of(surface, place);
  for (const double bound_mm : {-band_mm, band_mm})
    chart.dashed(span.lowest, bound_mm, span.highest, bound_mm, kGrey, 1);
  means.draw(chart, kBlack);
}

// Bars of 4 mm, and the normal distribution of the same sd.
void draw_histogram(Paper& paper, const cv::Rect& area, const Surface& surface) {
  constexpr double kBar_mm = 4.0;
  constexpr int kBars = static_cast<int>(2.0 * kShownOff_mm / kBar_mm);
  std::array<double, kBars> shares{};
  const double one = 100.0 / static_cast<double>(std::max<std::size_t>(1, surface.points.size()));
  for (const SurfacePoint& point : surface.points) {
    const double bar = (mm_from_m(point.off_m) + kShownOff_mm) / kBar_mm;
    if (bar >= 0.0 && bar < kBars) shares[static_cast<std::size_t>(bar)] += one;
  }
  const double most = *std::max_element(shares.begin(), shares.end());
  Chart chart(paper, area, {-kShownOff_mm, kShownOff_mm}, {0.0, 1.2 * std::max(most, 1.0)});
  chart.draw_axes("off the plane, mm", "points, % a bar of 4 mm");
  double left_mm = -kShownOff_mm;
  for (const double share : shares) {
    const cv::Rect bar(chart.at(left_mm, share), chart.at(left_mm + kBar_mm, 0.0));
    cv::rectangle(paper.pixels(), bar, kSkyBlue, cv::FILLED);
    left_mm += kBar_mm;
  }
  const double sd_mm = mm_from_m(surface.sd_m);
  const auto normal = [&](double off_mm) {
    return 100.0 * kBar_mm / (sd_mm * std::sqrt(2 * kPi)) *
           std::exp(-0.5 * std::pow(off_mm / sd_mm, 2));
  };
  for (double off_mm = -kShownOff_mm; off_mm < kShownOff_mm; off_mm += 1.0)
    chart.line(off_mm, normal(off_mm), off_mm + 1.0, normal(off_mm + 1.0), kBlue, 2);
  for (const double bound_mm : {-mm_from_m(kLidarBand_m), mm_from_m(kLidarBand_m)})
    chart.dashed(bound_mm, 0.0, bound_mm, 1.2 * most, kGrey, 1);
}

// A floor or a ceiling: a scan line crosses it, and says nothing as a mean.
bool level(const Surface& surface) {
  return std::abs(surface.plane.normal.z()) > 0.5;
}

std::string surface_words(const Surface& surface) {
  const Eigen::Vector3d& n = surface.plane.normal;
  return surface.name + ": " + std::to_string(surface.points.size()) + " points, sd " +
         with_decimals(mm_from_m(surface.sd_m), 1) + " mm, " +
         with_decimals(100.0 * surface.share_within, 2) + " % within +-40 mm; normal (" +
         with_decimals(n.x(), 4) + ", " + with_decimals(n.y(), 4) + ", " + with_decimals(n.z(), 4) +
         "), " + with_decimals(surface.plane.distance_m, 3) + " m away";
}

}  // namespace

Outcome write_surfaces_chart(const std::string& path, const std::vector<Surface>& surfaces,
                             const PictureCaption& caption) {
  constexpr int kRow = 290;
  const int count = static_cast<int>(surfaces.size());
  Paper paper(kSheetWidth, 120 + std::max(count, 1) * kRow + 20);
  head(paper, "points off their fitted planes", caption);
  paper.write_legend({{kSkyBlue, "points; histogram"},
                      {kBlack, "mean a line, or a 0.1 m"},
                      {kBlue, "normal distribution, same sd"},
                      {kGrey, "+-40 mm"}},
                     {kSheetLeft, 98});
  for (int row = 0; row < count; ++row) {
    const Surface& surface = surfaces[static_cast<std::size_t>(row)];
    const int top = 110 + row * kRow;
    paper.write(surface_words(surface), {kSheetLeft, top + 30}, 17, kBlack);
    const cv::Rect first(kSheetLeft, top + 64, 420, 160);
    Chart along(paper, first, extent_of(surface, &SurfacePoint::along_m),
                {-kShownOff_mm, kShownOff_mm});
    draw_profile(along, surface, &SurfacePoint::along_m,
                 level(surface) ? MeanOf::kPlace : MeanOf::kLine, "along it, m (to the left)");
    Chart up(paper, first + cv::Point(500, 0) - cv::Size(180, 0),
             extent_of(surface, &SurfacePoint::up_m), {-kShownOff_mm, kShownOff_mm});
    draw_profile(up, surface, &SurfacePoint::up_m, MeanOf::kPlace, "up it, m");
    draw_histogram(paper, {first.x + 820, first.y, 270, 160}, surface);
  }
  if (count == 0) paper.write("no plane was found", {kSheetLeft, 220}, 20, kBlack);
  return paper.save(path);
}

namespace {

const Colour kPalePoint(216, 216, 216);
const Colour kPaleLast(150, 185, 245);

enum class End { kMiddle, kFirst, kLast };

// The first quarter of the lines, or the last.
End end_of(std::size_t line, std::size_t lines) {
  if (4 * line < lines) return End::kFirst;
  return 4 * (line + 1) > 3 * lines ? End::kLast : End::kMiddle;
}

const Colour& colour_of(End end) {
  if (end == End::kMiddle) return kPalePoint;
  return end == End::kFirst ? kBlue : kVermillion;
}

void draw_map(Paper& paper, const cv::Rect& area, const OrganisedCloud& cloud, double seam_rad) {
  const HeightBand band = band_between_floor_and_ceiling(cloud);
  const MapFrame frame({&cloud}, band, area.width, area.height);
  Chart chart(paper, area, {frame.left_m(), frame.right_m()}, {frame.bottom_m(), frame.top_m()});
  chart.draw_axes("X, m", "seen from above: Y, m");
  for (const End end : {End::kMiddle, End::kFirst, End::kLast}) {
    for (std::size_t place = 0; place < cloud.points.size(); ++place) {
      const CloudPoint& point = cloud.points[place];
      if (!band.holds(point) || end_of(place / cloud.beams, cloud.lines) != end) continue;
      chart.speck(static_cast<double>(point.x_m), static_cast<double>(point.y_m), colour_of(end));
    }
  }
  constexpr double kFar_m = 40.0;
  chart.line(-kFar_m * std::cos(seam_rad), -kFar_m * std::sin(seam_rad),
             kFar_m * std::cos(seam_rad), kFar_m * std::sin(seam_rad), kOrange, 2);
  chart.dot(0.0, 0.0, kBlack, 4);
}

// Distance off a wall over place along it, by least squares.
struct Straight {
  double at_zero = 0.0;
  double slope = 0.0;
};

Straight fit_straight(const std::vector<SurfacePoint>& points) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const SurfacePoint& point : points) {
    x += point.along_m;
    y += point.off_m;
    xx += point.along_m * point.along_m;
    xy += point.along_m * point.off_m;
  }
  const auto count = static_cast<double>(points.size());
  const double spread = count * xx - x * x;
  if (points.size() < 2 || spread < 1e-9) return {};
  const double slope = (count * xy - x * y) / spread;
  return {(y - slope * x) / count, slope};
}

constexpr double kSeamShown_m = 1.6;  // of the wall, to either side
constexpr double kSeamShown_mm = 60.0;

// How far the points about the seam lie off a wall that the first lines see level.
void draw_seam_place(Paper& paper, const cv::Rect& area, const Surface& wall,
                     const SeamPlace& place, std::size_t lines) {
  std::map<End, std::vector<SurfacePoint>> points;
  for (SurfacePoint point : wall.points) {
    point.along_m -= place.along_m;
    if (std::abs(point.along_m) < kSeamShown_m) points[end_of(point.line, lines)].push_back(point);
  }
  const Straight level = fit_straight(points[End::kFirst]);
  Chart chart(paper, area, {-kSeamShown_m, kSeamShown_m}, {-kSeamShown_mm, kSeamShown_mm});
  chart.draw_axes("along the " + wall.name + " from the seam, m", "off the first lines' wall, mm");
  for (const End end : {End::kFirst, End::kLast}) {
    Means means;
    const std::size_t stride = 1 + points[end].size() / 4000;
    for (std::size_t index = 0; index < points[end].size(); ++index) {
      const SurfacePoint& point = points[end][index];
      const double off_mm = mm_from_m(point.off_m - level.at_zero - level.slope * point.along_m);
      if (index % stride == 0)
        chart.speck(point.along_m, off_mm, end == End::kFirst ? kSkyBlue : kPaleLast);
      means.add(static_cast<long>(point.line), point.along_m, off_mm);
    }
    means.draw(chart, colour_of(end));
  }
  // For the eye: what a seam open by 1 deg would look like, on the side of the last lines.
  const auto& last = points[End::kLast];
  const double side_m = last.empty() || last.front().along_m > 0.0 ? kSeamShown_m : -kSeamShown_m;
  const double rise_mm = mm_from_m(kSeamShown_m) * std::tan(rad_from_deg(1.0));
  for (const double sign : {-1.0, 1.0}) chart.dashed(0.0, 0.0, side_m, sign * rise_mm, kGrey, 1);
}

}  // namespace

Outcome write_seam_chart(const std::string& path, const OrganisedCloud& cloud,
                         const std::vector<Surface>& walls, const SeamSaid& said,
                         const PictureCaption& caption) {
  constexpr int kMapSide = 520;
  const double seam_rad = caption.phi_offset_rad.value_or(0.0) + kPi / 2;
  Paper paper(kSheetWidth, 760);
  head(paper, "the seam", caption);
  paper.write_legend({{kBlue, "first quarter of the lines"},
                      {kVermillion, "last quarter"},
                      {kPalePoint, "between"},
                      {kOrange, "seam"}},
                     {kSheetLeft, 98});
  draw_map(paper, {kSheetLeft, 134, kMapSide, kMapSide}, cloud, seam_rad);
  int top = 134;
  for (const double azimuth_rad : {seam_rad, seam_rad + kPi}) {
    const auto place = seam_place(walls, azimuth_rad);
    const cv::Rect area(kSheetLeft + kMapSide + 100, top, 460, 190);
    if (place) {
      draw_seam_place(paper, area, walls[place->surface], *place, cloud.lines);
    } else {
      paper.write("no wall was found on this side", area.tl() + cv::Point(0, 30), 17, kBlack);
    }
    top += 274;
  }
  paper.write(std::isnan(said.further_deg)
                  ? "seam_deg: not known"
                  : "seam_deg " + with_decimals(said.further_deg, 3) + " +- " +
                        with_decimals(said.sigma_deg, 3) + ": further than said",
              {kSheetLeft + kMapSide + 100, 704}, 17, kBlack);
  paper.write("dashed: a seam open by 1 deg", {kSheetLeft + kMapSide + 100, 732}, 17, kGrey);
  return paper.save(path);
}

namespace {

// Of a turning frame, in mm: X' to the right, Y' up.
void draw_turned(Chart& chart, const std::vector<cv::Point2d>& corners_mm, double turn_rad,
                 const Colour& colour, bool closed) {
  const auto turned = [&](const cv::Point2d& p) {
    return cv::Point2d(std::cos(turn_rad) * p.x - std::sin(turn_rad) * p.y,
                       std::sin(turn_rad) * p.x + std::cos(turn_rad) * p.y);
  };
  const std::size_t sides = closed ? corners_mm.size() : corners_mm.size() - 1;
  for (std::size_t side = 0; side < sides; ++side) {
    const cv::Point2d from = turned(corners_mm[side]);
    const cv::Point2d to = turned(corners_mm[(side + 1) % corners_mm.size()]);
    chart.line(from.x, from.y, to.x, to.y, colour, 2);
  }
}

void draw_half_ring(Chart& chart, const PlateGeometry& plate) {
  for (const double radius_m : {plate.ring_inner_m, plate.ring_outer_m}) {
    const double radius_mm = mm_from_m(radius_m);
    for (int degree = -90; degree < 90; degree += 2) {
      const double from_rad = rad_from_deg(degree), to_rad = rad_from_deg(degree + 1);
      chart.line(radius_mm * std::cos(from_rad), radius_mm * std::sin(from_rad),
                 radius_mm * std::cos(to_rad), radius_mm * std::sin(to_rad), kGrey, 1);
    }
  }
}

// The plate as drawn, and its middle line from the axis.
void draw_plate(Chart& chart, const PlateGeometry& plate, double beta_rad) {
  const double base_mm = mm_from_m(plate.base_distance_m);
  const double half_mm = mm_from_m(plate.hypotenuse_m) / 2;
  draw_turned(chart, {{base_mm, -half_mm}, {base_mm + half_mm, 0.0}, {base_mm, half_mm}}, beta_rad,
              kBlack, true);
  const double tip_mm = base_mm + half_mm + 12.0;
  chart.dashed(0.0, 0.0, tip_mm * std::cos(beta_rad), tip_mm * std::sin(beta_rad), kBlack, 1);
}

void draw_beams(Chart& chart, const std::vector<PlateBeam>& beams) {
  const int size = beams.size() > 20'000 ? 2 : beams.size() > 4'000 ? 3 : 5;
  for (const PlateBeam& beam : beams)
    chart.speck(mm_from_m(beam.x_m), mm_from_m(beam.y_m), beam.in_ring ? kBlue : kOrange, size);
}

}  // namespace

Outcome write_plate_chart(const std::string& path, const std::vector<PlateBeam>& beams,
                          const PlateGeometry& plate, const std::optional<PlateBeta>& beta,
                          const PictureCaption& caption) {
  const auto hits =
      std::count_if(beams.begin(), beams.end(), [](const PlateBeam& beam) { return beam.in_ring; });
  Paper paper(kSheetWidth / 2 + 200, 1200);
  PictureCaption in_start = caption;
  in_start.frame = "O'";
  head(paper, "the plate", in_start);
  paper.write_legend({{kBlue, "met the plate"}, {kOrange, "did not"}, {kBlack, "plate as drawn"}},
                     {kSheetLeft, 98});
  Chart chart(paper, {kSheetLeft, 134, 640, 960}, {-20.0, 140.0}, {-120.0, 120.0});
  chart.draw_axes("X', mm", "seen from above, on the plate's plane: Y', mm");
  draw_beams(chart, beams);
  draw_half_ring(chart, plate);
  if (beta) draw_plate(chart, plate, beta->beta_rad);
  chart.dot(0.0, 0.0, kBlack, 5);
  const cv::Point axis = chart.at(0.0, 0.0);
  paper.write("axis", axis + cv::Point(10, 22), 17, kBlack);
  paper.write(beta ? "beta " + with_decimals(deg_from_rad(beta->beta_rad), 3) + " +- " +
                         with_decimals(deg_from_rad(beta->sigma_rad), 3) + " deg"
                   : "beta is not known: no outline is drawn",
              {kSheetLeft, 1164}, 18, kBlack);
  paper.write(std::to_string(beams.size()) + " beams come down in the half ring, " +
                  std::to_string(hits) + " measured in it",
              {kSheetLeft, 1188}, 17, kGrey);
  return paper.save(path);
}

}  // namespace swivel
