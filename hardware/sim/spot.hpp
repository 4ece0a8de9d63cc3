// What a beam of finite width meets: on one surface that is what its centre meets, on an edge a
// bundle of rays tells how much of it falls on either side.
#pragma once

#include <optional>
#include <vector>

#include "hardware/sim/lidar_options.hpp"
#include "hardware/sim/random.hpp"
#include "hardware/sim/world.hpp"

namespace swivel::sim {

struct Echo {
  double distance_m = 0.0;
  double strength = 0.0;  // as the sensor shows it
};

class Spot {
 public:
  explicit Spot(const LidarOptions& options);

  // What the sensor answers; none when nothing comes back.
  std::optional<Echo> echo(const World& world, const Ray& centre, Random& random) const;

 private:
  struct Offset {  // from the centre, in radii
    double across = 0.0;
    double along = 0.0;
    double hand = 1.0;  // the sense in which it is askew, 1 or -1
    double weight = 0.0;
  };
  // Of one surface, or of several too near to one another to be told apart.
  struct Return {
    double farthest_m = 0.0;
    double energy = 0.0;
    double energy_m = 0.0;  // sum of energy * distance
    double strength = 0.0;

    double distance_m() const { return energy_m / energy; }
  };
  struct PartialHit {
    Hit hit;
    double weight = 0.0;
  };
  class Bundle;

  static std::vector<Offset> spiral(int count);
  static std::vector<PartialHit> hits(const World& world, const Bundle& bundle,
                                      const std::vector<Offset>& rays);
  std::vector<Return> returns(std::vector<PartialHit> hits) const;
  static double total_energy(const std::vector<Return>& returns);
  bool close_call(const std::vector<Return>& returns) const;
  Echo chosen(const std::vector<Return>& returns, Random& random) const;

  LidarOptions options_;
  std::vector<Offset> rays_;
  std::vector<Offset> fine_rays_;
  std::vector<Offset> rim_;
};

}  // namespace swivel::sim
