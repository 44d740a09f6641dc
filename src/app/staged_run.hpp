#pragma once

#include "explicit_run.hpp"
#include "input.hpp"

#include <nlohmann/json.hpp>

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
  const CycleWork& work() const { return work_; }

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
  CycleWork work_;
};

}  // namespace eigengrain::app
