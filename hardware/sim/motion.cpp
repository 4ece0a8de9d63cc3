#include "hardware/sim/motion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "hardware/sim/sim_time.hpp"

namespace swivel::sim {
namespace {

constexpr std::int64_t kKeptNs = 10'000'000'000;  // scan lines look back, but not this far

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

}  // namespace

double MotionPiece::position_at(std::int64_t time_ns) const {
  const double t = seconds(std::max<std::int64_t>(0, time_ns - start_ns));
  return position_steps + t * (speed_steps_s + 0.5 * t * acceleration_steps_s2);
}

double MotionPiece::speed_at(std::int64_t time_ns) const {
  return speed_steps_s +
         acceleration_steps_s2 * seconds(std::max<std::int64_t>(0, time_ns - start_ns));
}

Motion::Motion(std::int64_t now_ns, const StepLoss& loss)
    : pieces_{MotionPiece{now_ns}}, loss_(loss) {}

const MotionPiece& Motion::piece_at(std::int64_t time_ns) const {
  const auto after = std::upper_bound(
      pieces_.begin(), pieces_.end(), time_ns,
      [](std::int64_t time, const MotionPiece& piece) { return time < piece.start_ns; });
  return after == pieces_.begin() ? pieces_.front() : *std::prev(after);
}

// The piece that goes on where `piece` is at `time_ns`, without acceleration.
MotionPiece Motion::continued(const MotionPiece& piece, std::int64_t time_ns) const {
  MotionPiece next{time_ns, piece.position_at(time_ns), piece.speed_at(time_ns),
                   0.0,     piece.travelled_steps,      piece.lost_steps};
  if (loss_.every <= 0 || time_ns <= loss_.since_ns) return next;
  const std::int64_t counted_from_ns = std::max(piece.start_ns, loss_.since_ns);
  const double way = next.position_steps - piece.position_at(counted_from_ns);
  next.travelled_steps += std::abs(way);
  const double lost = std::floor(next.travelled_steps / loss_.every) -
                      std::floor(piece.travelled_steps / loss_.every);
  next.lost_steps += way < 0.0 ? -lost : lost;
  return next;
}

double Motion::motor_steps_at(std::int64_t time_ns) const {
  const MotionPiece state = continued(piece_at(time_ns), time_ns);
  return std::round(state.position_steps) - state.lost_steps;
}

// What was to come after `now_ns` is forgotten; what was, stays, for scan lines under way.
void Motion::cut(std::int64_t now_ns) {
  const MotionPiece last = piece_at(now_ns);
  while (!pieces_.empty() && pieces_.back().start_ns >= now_ns) pieces_.pop_back();
  pieces_.push_back(continued(last, now_ns));
  while (pieces_.size() > 2 && pieces_[1].start_ns < now_ns - kKeptNs) pieces_.pop_front();
}

// Gives the last piece an acceleration and a duration, and begins the next one.
void Motion::append(double acceleration, double duration_s) {
  if (duration_s <= 0.0) return;
  MotionPiece& piece = pieces_.back();
  piece.acceleration_steps_s2 = acceleration;
  const std::int64_t end_ns = piece.start_ns + std::llround(duration_s * 1e9);
  pieces_.push_back(continued(piece, end_ns));
}

void Motion::add(const Move& move, double acceleration_steps_s2, std::int64_t now_ns,
                 std::int64_t not_before_ns) {
  assert(move.speed_steps_s > 0.0 && acceleration_steps_s2 > 0.0);
  drop_finished(now_ns);
  if (moves_.empty()) not_before_ns_ = not_before_ns;
  acceleration_ = acceleration_steps_s2;
  moves_.push_back(move);
  plan(now_ns);
}

void Motion::resume(std::int64_t now_ns) {
  if (!moves_.empty()) plan(now_ns);
}

void Motion::brake(std::int64_t now_ns) {
  drop_finished(now_ns);
  cut(now_ns);
  const double from = pieces_.back().position_steps;
  const double speed = pieces_.back().speed_steps_s;
  append(speed > 0.0 ? -acceleration_ : acceleration_, std::abs(speed) / acceleration_);
  pieces_.back().speed_steps_s = 0.0;
  const double rest = pieces_.back().position_steps;
  const auto passed = [&](const Move& move) {
    return (move.target_steps - from) * (rest - move.target_steps) > 0.0;
  };
  while (moves_.size() > 1 && passed(moves_.front())) moves_.pop_front();
  for (Move& move : moves_) move.end_ns = kNever_ns;
}

void Motion::forget_moves() {
  moves_.clear();
}

void Motion::halt(std::int64_t now_ns) {
  place(std::round(position_at(now_ns)), now_ns);
}

void Motion::place(double position_steps, std::int64_t now_ns) {
  cut(now_ns);
  pieces_.back().speed_steps_s = 0.0;
  pieces_.back().position_steps = position_steps;
  moves_.clear();
}

void Motion::lose(double steps, std::int64_t now_ns) {
  const MotionPiece& present = piece_at(now_ns);
  for (MotionPiece& piece : pieces_) {
    if (piece.start_ns >= present.start_ns) piece.lost_steps += steps;
  }
}

void Motion::glide(double target_steps, double duration_s, std::int64_t start_ns) {
  cut(start_ns);
  pieces_.back().speed_steps_s = (target_steps - pieces_.back().position_steps) / duration_s;
  append(0.0, duration_s);
  pieces_.back().speed_steps_s = 0.0;
  pieces_.back().position_steps = target_steps;
}

void Motion::drop_finished(std::int64_t now_ns) {
  while (!moves_.empty() && moves_.front().end_ns <= now_ns) {
    moves_.pop_front();
  }
}

// How fast the axis may be where the move `first` ends and the one after it begins.
double Motion::junction_speed(std::size_t first) const {
  if (first + 1 >= moves_.size()) return 0.0;
  const double from = first == 0 ? pieces_.back().position_steps : moves_[first - 1].target_steps;
  const double before = moves_[first].target_steps - from;
  const double after = moves_[first + 1].target_steps - moves_[first].target_steps;
  if (before * after <= 0.0) return 0.0;
  return std::min(moves_[first].speed_steps_s, moves_[first + 1].speed_steps_s);
}

void Motion::plan(std::int64_t now_ns) {
  cut(now_ns);
  append(0.0, seconds(std::max<std::int64_t>(0, not_before_ns_ - now_ns)));
  std::deque<double> exit_speeds(moves_.size(), 0.0);  // each slow enough to stop at the end
  for (std::size_t i = moves_.size() - 1; i > 0; --i) {
    const double length = std::abs(moves_[i].target_steps - moves_[i - 1].target_steps);
    const double stoppable =
        std::sqrt(exit_speeds[i] * exit_speeds[i] + 2.0 * acceleration_ * length);
    exit_speeds[i - 1] = std::min(junction_speed(i - 1), stoppable);
  }
  for (std::size_t i = 0; i < moves_.size(); ++i) plan_move(moves_[i], exit_speeds[i]);
}

// A trapezoid, or a triangle when the move is too short to reach its speed.
void Motion::plan_move(Move& move, double exit_speed) {
  const MotionPiece from = pieces_.back();
  const double way = move.target_steps - from.position_steps;
  const double direction = way < 0.0 ? -1.0 : 1.0;
  const double length = std::abs(way);
  const double entry = std::abs(from.speed_steps_s);
  const double a = acceleration_;
  const double exit = std::min(exit_speed, std::sqrt(entry * entry + 2.0 * a * length));
  const double reachable = std::sqrt(a * length + 0.5 * (entry * entry + exit * exit));
  const double peak = std::max(entry, std::min(move.speed_steps_s, reachable));
  const double ramps = (2.0 * peak * peak - entry * entry - exit * exit) / (2.0 * a);
  append(direction * a, (peak - entry) / a);
  append(0.0, std::max(0.0, length - ramps) / std::max(peak, 1e-9));
  append(-direction * a, (peak - exit) / a);
  pieces_.back().position_steps = move.target_steps;
  pieces_.back().speed_steps_s = direction * exit;
  move.end_ns = pieces_.back().start_ns;
}

}  // namespace swivel::sim
