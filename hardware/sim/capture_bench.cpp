#include "hardware/sim/capture_bench.hpp"

#include <algorithm>
#include <utility>

#include "hardware/sim/poll_until.hpp"

namespace swivel::sim {

CaptureBench::CaptureBench(CaptureBenchOptions options, CapturedDevice::OnNews on_news)
    : lidar_("lidar", std::move(options.lidar), "", on_news),
      stepper_("stepper", std::move(options.stepper), kGrblAtOnce, std::move(on_news)),
      lidar_port_(lidar_, options.port),
      stepper_port_(stepper_, options.stepper_link) {
  // A sweep is asked for when the user likes; the lidar must see what it saw on that turn.
  stepper_.on_line([this](const std::string& line, std::int64_t captured_ns, std::int64_t now_ns) {
    if (line.compare(0, 3, "$J=") == 0) lidar_.align(captured_ns, now_ns);
  });
}

void CaptureBench::run(const WakeUp& stop) {
  while (!is_notified(stop)) {
    const std::int64_t time_ns = now_ns();
    stepper_port_.serve(time_ns);
    if (stepper_.takes_leave()) stepper_port_.unplug(0.0, time_ns);
    lidar_port_.serve(time_ns);
    std::vector<pollfd> waits = {{stop.descriptor(), POLLIN, 0}};
    lidar_port_.add_to(waits);
    stepper_port_.add_to(waits);
    poll_until(std::min(lidar_port_.next_event_ns(time_ns), stepper_port_.next_event_ns(time_ns)),
               waits);
  }
}

}  // namespace swivel::sim
