// GRBL 1.1: the pure protocol, bytes <-> values. docs/protocols.md has the conversation.
//
// To the controller: single real-time bytes, taken at any time, and lines ended by LF of which
// one at most waits for its answer.
//   ?     status query          0x85  jog cancel          0x18  soft reset
//   $$    list the settings     $X    unlock              $H    home
//   $J=G53 G21 X<deg> F<deg/min>                           jog to a machine position
// From the controller, lines ended by CR LF:
//   answer   = "ok" | "error:" code
//   alarm    = "ALARM:" code
//   status   = "<" state *( "|" field ) ">"
//   state    = name [ ":" digit ]           Idle Run Hold Jog Alarm Door Check Home Sleep
//   field    = "MPos:" x *( "," n ) | "WPos:" x *( "," n ) | "WCO:" x *( "," n )
//            | "FS:" feed "," spindle | "F:" feed | "Pn:" letters | "Ov:" f "," r "," s | other
//   banner   = "Grbl " version " [" text "]"
//   setting  = "$" number "=" value
//   feedback = "[" tag ":" text "]"         MSG VER OPT PRB GC ...
// GRBL's unit of length is the axis' degree here, its rate deg/min; only X is used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace swivel {

inline constexpr char kGrblStatusQuery = '?';
inline constexpr char kGrblJogCancel = '\x85';
inline constexpr char kGrblReset = '\x18';

// The line that turns to `machine_deg` (MPos, not counted from the home switch).
std::string grbl_jog_line(double machine_deg, double speed_deg_s);

enum class GrblState { kIdle, kRun, kHold, kJog, kAlarm, kDoor, kCheck, kHome, kSleep };
const char* grbl_state_name(GrblState state);

struct GrblOk {};
struct GrblError {
  int code = 0;
};
struct GrblAlarm {
  int code = 0;
};
struct GrblBanner {
  std::string version;  // "1.1h"
};
struct GrblSetting {
  int number = 0;
  double value = 0.0;
};
struct GrblFeedback {
  std::string tag;  // "MSG"
  std::string text;
};
struct GrblStatus {
  GrblState state = GrblState::kAlarm;
  std::optional<int> substate;
  std::optional<double> machine_deg;                    // MPos
  std::optional<double> work_deg;                       // WPos
  std::optional<double> work_offset_deg;                // WCO = MPos - WPos; sent now and then
  std::optional<double> speed_deg_s;                    // the planner's, not the shaft's
  std::string active_pins;                              // "X": on the home switch
  std::optional<std::array<int, 3>> overrides_percent;  // feed, rapids, spindle
};

using GrblMessage =
    std::variant<GrblOk, GrblError, GrblAlarm, GrblStatus, GrblBanner, GrblSetting, GrblFeedback>;

// One line without its line end; empty when it is none of the grammar's.
std::optional<GrblMessage> parse_grbl_line(std::string_view line);

// A push parser: the same messages come out however the bytes are chopped.
class GrblParser {
 public:
  static constexpr std::size_t kLongestLine = 256;

  std::vector<GrblMessage> push(std::string_view bytes);

  // Lines that are not of the grammar, or too long. Many of them: the wrong baud rate.
  std::uint64_t garbage_lines() const { return garbage_lines_; }
  std::uint64_t bytes_received() const { return bytes_received_; }

 private:
  void end_line(std::vector<GrblMessage>& messages);

  std::string line_;
  bool too_long_ = false;
  std::uint64_t garbage_lines_ = 0;
  std::uint64_t bytes_received_ = 0;
};

// What the code means and what to do: "error:9: it is locked; ...".
std::string grbl_error_words(int code);
std::string grbl_alarm_words(int code);

}  // namespace swivel
