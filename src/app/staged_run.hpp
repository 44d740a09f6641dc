#pragma once

#include "input.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace eigengrain::app {

/// The stages of a scene, from the one that the input has come to on. Between two of them the state is in its
/// file, so a run that was stopped goes on with the stage that it was in.
class StagedRun {
 public:
  explicit StagedRun(Input input);

  /// Ends after the last stage or at an interrupt.
  void go();

  /// Whether no stage is left.
  bool done() const { return !in_hand(); }
  const assembly::State& state() const { return input_.state; }
  const std::filesystem::path& state_file() const { return state_file_; }
  /// One entry a stage, and repetition, that was done.
  const nlohmann::ordered_json& report() const { return report_; }
  std::int64_t steps() const { return steps_; }
  double seconds() const { return seconds_; }  ///< of the cycle alone
  std::int64_t broken() const { return broken_; }

 private:
  bool in_hand() const;
  const model::Stage& stage() const;
  std::string title() const;
  void begin();
  void run();
  void relax();
  void finish();

  Input input_;
  std::filesystem::path state_file_;
  nlohmann::ordered_json report_ = nlohmann::ordered_json::array();
  std::int64_t steps_ = 0;
  double seconds_ = 0;
  std::int64_t broken_ = 0;
};

}  // namespace eigengrain::app
