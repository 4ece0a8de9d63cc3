#include "hardware/sim/spot.hpp"

#include <algorithm>
#include <cmath>

namespace swivel::sim {
namespace {

constexpr int kRays = 91;
constexpr int kFineRays = 1000;
constexpr double kCloseCall = 0.08;  // of the energy: so far off may its part by few rays be
constexpr int kRimRays = 8;
constexpr double kGoldenAngle_rad = 2.399963229728653;
constexpr double kTurn_rad = 360.0 * kRadPerDeg;
constexpr double kGoodEcho = 0.1;    // of the energy, to be part of a mixed pixel
constexpr double kBrightest = 4500;  // white, square, at arm's length
constexpr double kHalfwayM = 4.0;    // where an echo is half as strong

double strength_of(const Hit& hit) {
  const double distance = hit.distance_m / kHalfwayM;
  return kBrightest * hit.reflectivity * hit.cos_incidence / (1.0 + distance * distance);
}

}  // namespace

// Places a ray by its offset. Rays that pass one another askew, half of them each way round, make a
// beam that widens as a Gaussian one does: radius^2 = (at the lidar)^2 + (divergence * distance)^2.
class Spot::Bundle {
 public:
  Bundle(const Ray& centre, const LidarOptions& options)
      : centre_(centre),
        radius_m_(options.spot_radius_mm * 1e-3),
        divergence_(options.divergence_mrad * 1e-3) {
    const Vector3 reference =
        std::abs(centre.direction.z) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0};
    const Vector3 raw = cross(centre.direction, reference);
    across_ = 1.0 / std::sqrt(dot(raw, raw)) * raw;
    along_ = cross(across_, centre.direction);
  }

  Ray ray(const Offset& offset) const {
    const Vector3 aside = offset.across * across_ + offset.along * along_;
    const Vector3 askew = offset.hand * (offset.across * along_ - offset.along * across_);
    const Vector3 direction = centre_.direction + divergence_ * askew;
    return {centre_.origin + radius_m_ * aside,
            1.0 / std::sqrt(dot(direction, direction)) * direction};
  }

 private:
  Ray centre_;
  double radius_m_;
  double divergence_;
  Vector3 across_;
  Vector3 along_;
};

// They lie evenly over the spot, on a spiral (Vogel 1979), and weigh what the beam does there.
std::vector<Spot::Offset> Spot::spiral(int count) {
  std::vector<Offset> rays;
  double sum = 0.0;
  for (int ray = 0; ray < count; ++ray) {
    const double area = (ray + 0.5) / count;
    const double angle = ray * kGoldenAngle_rad;
    const double radius = std::sqrt(area);
    const double hand = ray % 2 == 0 ? 1.0 : -1.0;
    rays.push_back(
        {radius * std::cos(angle), radius * std::sin(angle), hand, std::exp(-2.0 * area)});
    sum += rays.back().weight;
  }
  for (Offset& ray : rays) ray.weight /= sum;
  return rays;
}

Spot::Spot(const LidarOptions& options)
    : options_(options), rays_(spiral(kRays)), fine_rays_(spiral(kFineRays)) {
  for (int ray = 0; ray < kRimRays; ++ray) {
    const double angle = ray * kTurn_rad / kRimRays;
    rim_.push_back({std::cos(angle), std::sin(angle), 1.0, 0.0});
  }
}

std::optional<Echo> Spot::echo(const World& world, const Ray& centre, Random& random) const {
  const auto middle = world.cast(centre);
  const auto whole =
      middle ? std::optional<Echo>({middle->distance_m, strength_of(*middle)}) : std::nullopt;
  if (options_.spot_radius_mm <= 0.0) return whole;
  const Bundle bundle(centre, options_);
  const auto same = [&](const Offset& offset) {
    const auto hit = world.cast(bundle.ray(offset));
    return hit && middle ? hit->surface == middle->surface : !hit && !middle;
  };
  if (std::all_of(rim_.begin(), rim_.end(), same)) return whole;
  auto found = returns(hits(world, bundle, rays_));
  if (close_call(found)) found = returns(hits(world, bundle, fine_rays_));
  return found.empty() ? std::nullopt : std::optional<Echo>(chosen(found, random));
}

std::vector<Spot::PartialHit> Spot::hits(const World& world, const Bundle& bundle,
                                         const std::vector<Offset>& rays) {
  std::vector<PartialHit> hits;
  hits.reserve(rays.size());
  for (const Offset& offset : rays) {
    if (const auto hit = world.cast(bundle.ray(offset))) hits.push_back({*hit, offset.weight});
  }
  return hits;
}

// In order of distance.
std::vector<Spot::Return> Spot::returns(std::vector<PartialHit> hits) const {
  std::sort(hits.begin(), hits.end(), [](const PartialHit& a, const PartialHit& b) {
    return a.hit.distance_m < b.hit.distance_m;
  });
  std::vector<Return> returns;
  for (const auto& [hit, weight] : hits) {
    const double merge_m = options_.echo_merge_mm * 1e-3;
    if (returns.empty() || hit.distance_m - returns.back().farthest_m > merge_m) {
      returns.emplace_back();
    }
    const double near_gain = 1.0 / (1.0 + hit.distance_m / (options_.gain_knee_mm * 1e-3));
    const double energy = weight * hit.reflectivity * hit.cos_incidence * near_gain;
    Return& last = returns.back();
    last.farthest_m = hit.distance_m;
    last.energy += energy;
    last.energy_m += energy * hit.distance_m;
    last.strength += weight * strength_of(hit);
  }
  return returns;
}

double Spot::total_energy(const std::vector<Return>& returns) {
  double total = 0.0;
  for (const Return& each : returns) total += each.energy;
  return total;
}

// Whether so few rays may tell wrongly which return is answered. They are no round spot: an edge
// lay up to 0.16 mm elsewhere by the way its normal pointed. Beams meet the plate's two legs at
// unlike angles, so that its azimuth seemed 0.01 to 0.04 deg off, by how many rays there were.
bool Spot::close_call(const std::vector<Return>& returns) const {
  if (returns.size() < 2) return false;
  const double total = total_energy(returns);
  const double reach = options_.echo_fraction * options_.echo_jitter + kCloseCall;
  return std::any_of(returns.begin(), returns.end(), [&](const Return& each) {
    return std::abs(each.energy / total - options_.echo_fraction) < reach;
  });
}

Echo Spot::chosen(const std::vector<Return>& returns, Random& random) const {
  const auto stronger = [](const Return& a, const Return& b) { return a.energy < b.energy; };
  const auto strongest = std::max_element(returns.begin(), returns.end(), stronger);
  const double total = total_energy(returns);
  const double needed =
      total * options_.echo_fraction * (1.0 + options_.echo_jitter * random.uniform(-1.0, 1.0));
  const bool mixed =
      strongest->energy < (1.0 - kGoodEcho) * total && random.uniform() < options_.mixed_pixel_rate;
  if (mixed) {
    const double nearest_m = returns.front().distance_m();
    const double step_m = returns.back().distance_m() - nearest_m;
    return {nearest_m + random.uniform() * step_m, returns.front().strength};
  }
  const auto enough = std::find_if(returns.begin(), returns.end(),
                                   [needed](const Return& each) { return each.energy >= needed; });
  const Return& answered = enough == returns.end() ? *strongest : *enough;
  return {answered.distance_m(), answered.strength};
}

}  // namespace swivel::sim
