// Motion of one axis, in motor steps: a queue of moves with one acceleration, planned so that
// moves that go on in the same direction do not stop between. Pure: time is an argument.
#pragma once

#include <cstdint>
#include <deque>

namespace swivel::sim {

// From `start_ns` on, until the next piece: position + speed t + acceleration t^2 / 2. No
// piece turns back.
struct MotionPiece {
  std::int64_t start_ns = 0;
  double position_steps = 0.0;
  double speed_steps_s = 0.0;
  double acceleration_steps_s2 = 0.0;
  double travelled_steps = 0.0;  // by its start, there and back, since steps began to be lost
  double lost_steps = 0.0;       // by its start; those lost on the way back count backwards

  double position_at(std::int64_t time_ns) const;
  double speed_at(std::int64_t time_ns) const;
};

struct StepLoss {
  int every = 0;  // each Nth step does not turn the motor; 0 for none
  std::int64_t since_ns = 0;
};

struct Move {
  double target_steps = 0.0;
  double speed_steps_s = 0.0;           // not negative
  double believed_speed_steps_s = 0.0;  // what the controller takes it for
  std::int64_t end_ns = 0;              // set by the plan
};

class Motion {
 public:
  explicit Motion(std::int64_t now_ns, const StepLoss& loss = {});

  // Starts at `not_before_ns` when at rest, else goes on from the moves before.
  void add(const Move& move, double acceleration_steps_s2, std::int64_t now_ns,
           std::int64_t not_before_ns);
  void brake(std::int64_t now_ns);   // slows down to rest; the moves are kept
  void resume(std::int64_t now_ns);  // goes on with them
  void forget_moves();
  void halt(std::int64_t now_ns);  // stands still at once, as when the pulses end
  void place(double position_steps, std::int64_t now_ns);  // halts there
  void lose(double steps, std::int64_t now_ns);            // that many more, all at once
  // At one speed to `target_steps`, with no regard to acceleration: the homing cycle.
  void glide(double target_steps, double duration_s, std::int64_t start_ns);

  double position_at(std::int64_t time_ns) const { return piece_at(time_ns).position_at(time_ns); }
  // Where the motor really is: whole steps, less those lost.
  double motor_steps_at(std::int64_t time_ns) const;
  double speed_at(std::int64_t time_ns) const { return piece_at(time_ns).speed_at(time_ns); }
  bool moving(std::int64_t now_ns) const { return now_ns < pieces_.back().start_ns; }

  void drop_finished(std::int64_t now_ns);
  const std::deque<Move>& moves() const { return moves_; }  // after drop_finished
  double end_steps() const {
    return moves_.empty() ? pieces_.back().position_steps : moves_.back().target_steps;
  }
  double lost_steps_now() const { return pieces_.back().lost_steps; }  // once at rest

 private:
  const MotionPiece& piece_at(std::int64_t time_ns) const;
  MotionPiece continued(const MotionPiece& piece, std::int64_t time_ns) const;
  void cut(std::int64_t now_ns);
  void append(double acceleration, double duration_s);
  void plan(std::int64_t now_ns);
  void plan_move(Move& move, double exit_speed);
  double junction_speed(std::size_t first) const;

  std::deque<MotionPiece> pieces_;  // the last one stands still
  std::deque<Move> moves_;
  double acceleration_ = 1.0;  // steps/s^2
  std::int64_t not_before_ns_ = 0;
  StepLoss loss_;
};

}  // namespace swivel::sim
