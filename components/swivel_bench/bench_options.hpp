// The options of swivel-bench on the command line: they win over those of the file.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <string>
#include <vector>

#include "hardware/sim/bench.hpp"

namespace swivel {

class BenchCommandLine {
 public:
  explicit BenchCommandLine(CLI::App& app);

  // Once parsed: the file, then what the command line changes in it. Throws
  // ConfigurationError.
  sim::BenchOptions options() const;
  const std::string& log_level() const { return log_level_; }
  const std::string& capture() const { return capture_; }  // to be served again; empty: none

 private:
  using Change = std::function<void(sim::BenchOptions&)>;

  void add_files(CLI::App& app);
  void add_world(CLI::App& app);
  void add_lidar(CLI::App& app);
  void add_motor(CLI::App& app);
  void add_misbehaviour(CLI::App& app);

  template <class Value>
  CLI::Option* option(CLI::App& app, const std::string& name, const std::string& help,
                      const std::function<void(sim::BenchOptions&, const Value&)>& change) {
    return app.add_option_function<Value>(
        name,
        [this, change](const Value& value) {
          changes_.push_back([change, value](sim::BenchOptions& bench) { change(bench, value); });
        },
        help);
  }
  void flag(CLI::App& app, const std::string& name, const std::string& help, const Change& change);

  void add_triple(CLI::App& app, const std::string& name, const std::string& help,
                  sim::Vector3 sim::Placement::*part);

  std::string file_;
  std::string log_level_ = "info";
  std::string capture_;
  std::vector<Change> changes_;
};

}  // namespace swivel
