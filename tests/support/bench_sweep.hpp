// A sweep of the plate rig on the bench's world, without wires and without DDS: cast by
// hardware/sim, assembled by calibration/, with its truth. The same options give the same sweep.
#pragma once

#include <cstdint>
#include <string>

#include "calibration/organised_cloud.hpp"
#include "hardware/sim/lidar.hpp"
#include "hardware/sim/world.hpp"

namespace swivel {

// How real lidar and plate are. kClean: range noise of 13 mm and a pencil beam. kReal: a spot,
// mixed pixels, 0.5 % dropouts besides. kRough: 20 mm, a spot twice as wide, 2 % dropouts, a range
// bias of 3 mm; the plate tilted by 1.5 and -1 deg and 1 mm too low.
enum class Tier { kClean, kReal, kRough };

// kSkewed: a square room without furniture, its front wall turned by 0.5 deg.
enum class Room { kSquare, kCluttered, kSkewed };

// The motor stands still while the controller goes on.
struct LostSteps {
  double angle_deg = 0.0;     // how far it falls behind; 0: no step is lost
  double after_turn_deg = 0;  // of the sweep, as the controller counts
};

struct BenchSweepOptions {
  int mode = 7;  // Yuan's: 40 to 640 lines over half a turn
  std::uint64_t seed = 1;
  sim::WorldOptions world;
  sim::LidarOptions lidar;
  double phi_start_deg = 0.0;  // where the scan plane's normal points at the first beam, in O
  double scan_period_ms = 25.0;
  LostSteps lost;
  // Casts only the low end of the fan, which passes the plate: as many beams has the cloud. Eight
  // times quicker; enough for what estimates the plate, not for walls.
  bool plate_beams_only = false;
};

struct BenchSweep {
  OrganisedCloud cloud;        // frame O', as if no step was lost
  double phi_start_rad = 0.0;  // the truth: what phi_offset should say
  double alpha_rad = 0.0;      // the truth
  double beta_rad = 0.0;       // the truth: of the plate's middle line in O'
  double angle_per_line_rad = 0.0;
};

const char* name_of(Tier tier);

// `options` with lidar and plate as the tier has them. Alpha stays.
BenchSweepOptions at_tier(Tier tier, BenchSweepOptions options);

sim::RoomOptions room_of(Room room);

// A sweep of that tier in a cluttered room: phi_start within 3 deg, alpha within 1 deg of 30,
// both drawn from the seed.
BenchSweepOptions drawn_sweep(Tier tier, int mode, std::uint64_t seed);

// Throws std::out_of_range for an unknown mode.
BenchSweep make_bench_sweep(const BenchSweepOptions& options);

}  // namespace swivel
