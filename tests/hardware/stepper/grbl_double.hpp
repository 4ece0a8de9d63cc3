// A small GRBL 1.1 on a pty, for tests: it speaks as facts measured on the firmware say, turns
// an ideal shaft (constant acceleration, whole jogs) and does on request what goes wrong in
// the field. It knows the truth: every jog that it ran.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace swivel::test {

// An ideal turn: from rest, trapezoidal (or triangular), to rest.
struct IdealTurn {
  std::int64_t start_ns = 0;
  double from_deg = 0.0;
  double to_deg = 0.0;
  double speed_deg_s = 0.0;
  double acceleration_deg_s2 = 0.0;
  std::int64_t cancelled_ns = 0;  // from then on it runs down; 0 for never
  std::int64_t cut_ns = 0;        // then it stops dead; 0 for never

  double length_deg() const;
  double peak_deg_s() const;
  double run_up_s() const;
  double duration_s() const;
  std::int64_t end_ns() const;
  double angle_deg(std::int64_t time_ns) const;  // machine position
  double speed_at(std::int64_t time_ns) const;
  std::int64_t steady_start_ns() const;
  std::int64_t steady_end_ns() const;
};

struct GrblDoubleOptions {
  std::map<int, double> settings = {{1, 255},   {13, 0},      {20, 1},     {22, 1},   {27, 1},
                                    {100, 100}, {110, 60000}, {120, 8000}, {130, 360}};
  double banner_delay_s = 0.0;  // after the pty is first read or 0x18
  bool banner_at_start = true;  // as an Arduino does when its port is opened
  bool answers_reset = true;
  std::string banner = "\r\nGrbl 1.1h ['$' for help]\r\n[MSG:'$H'|'$X' to unlock]\r\n";
  double homing_s = 0.05;
  int homing_alarm = 0;               // of the first homing; later ones succeed
  double turn_delay_s = 0.0;          // from ok to the first step; below 0: the ok is read late
  std::map<std::string, int> errors;  // by the line's beginning: error codes
  bool report_work_position = false;  // as with $10=0
};

class GrblDouble {
 public:
  explicit GrblDouble(GrblDoubleOptions options = {});
  ~GrblDouble();
  GrblDouble(const GrblDouble&) = delete;
  GrblDouble& operator=(const GrblDouble&) = delete;

  const std::string& address() const { return address_; }

  // What goes wrong.
  void raise_alarm(int code);  // stops the motor and locks
  void reset_itself();         // as after a glitch of its supply
  void fall_silent();          // hangs; the motor stands
  void stop_short();           // ends the present turn at once, and says Idle
  void unplug();               // closes its end
  void deafen_to_cancel();     // 0x85 does nothing any more

  // The truth.
  bool turning() const;
  std::vector<IdealTurn> turns() const;
  std::vector<std::string> lines() const;  // received; real-time bytes as ?, 0x85 and 0x18
  double machine_deg() const;
  int homings() const;

 private:
  void run();
  void take_byte(char byte);
  void take_line(const std::string& line);
  void start_homing();
  void finish_homing();
  void start_turn(const std::string& line);
  void cancel_turn();
  void reset();
  void boot();
  void cut();
  void report();
  void say(const std::string& text);
  bool turning_now() const;
  double machine_now() const;

  GrblDoubleOptions options_;
  std::string address_;
  int master_ = -1;
  int slave_ = -1;
  mutable std::mutex mutex_;
  std::string line_;
  std::vector<std::string> lines_;
  std::vector<IdealTurn> turns_;
  double homed_at_deg_ = 0.0;
  bool turned_since_homing_ = false;
  bool locked_ = true;
  bool silent_ = false;
  bool until_reset_ = false;
  bool ignores_cancel_ = false;
  bool first_report_ = true;
  int homings_ = 0;
  std::int64_t banner_due_ns_ = 0;  // 0 for none
  std::int64_t homed_due_ns_ = 0;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace swivel::test
