#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// Frames of a run for ParaView: FOLDER/STEM.pvd, which lists FOLDER/STEM_series/STEM_<step>.vtu.
///
/// A frame has a point a ball, in the order of identity, so that frames can be compared ball by ball: radius,
/// identity, clump (where there are any; -1: none), velocity, spin (where something turns), force (of all
/// contacts, N) and contacts (number of those that act), and stress if it is asked for (mean over the ball's
/// own volume, Pa, nine numbers, row by row: measures/measure.hpp); and the fields TimeValue (s) and Step.
/// All numbers are the run's own, to the bit.
///
/// Each file is there in full or not at all, and the list names only frames that are there: a run may be
/// killed at any time.
///
/// Of surfaces, a frame has their triangles where they are, with the number of the wall (from 0) that each
/// belongs to.
///
/// Of deformable bodies, a frame has their elements with stresses, and their nodes with displacements.
///
/// Of breaks, a frame has a point for each bond that broke until then, where its contact was: time, step,
/// mode (0: tension, 1: shear), ball_a, ball_b and normal.
class Series {
 public:
  enum class Of { balls, surfaces, solids, breaks };

  /// Nothing is written before the first frame, which replaces the list of an earlier run.
  /// stress  whether frames of balls have their stress
  Series(std::filesystem::path folder, std::string stem, Of what = Of::balls, bool stress = false);

  /// At a restart from this step, once, before the first frame: takes over the list that is there, without
  /// the frames after the step. That of the step itself stays. Throws InputError where the list is not one
  /// that a Series has written, or names a frame that is not there.
  void continue_from(std::int64_t step);

  /// Writes the frame of the state; nothing if there is a frame of this step. Steps must increase.
  ///
  /// breaks  all bonds that broke until then; for a series of breaks
  void add(const assembly::State& state, std::span<const assembly::BondBreak> breaks = {});

  std::filesystem::path list_file() const { return folder_ / (stem_ + ".pvd"); }
  std::filesystem::path frame_file(std::int64_t step) const { return folder_ / frame_name(step); }
  /// Steps of the frames, increasing.
  std::vector<std::int64_t> steps() const;

 private:
  struct Frame {
    std::int64_t step = 0;
    double time = 0;  ///< s
  };

  std::string frame_name(std::int64_t step) const;
  std::string list_line(const Frame& frame) const;
  std::string list_text() const;
  std::vector<Frame> read_list(std::string_view text) const;
  void write_list() const;

  std::filesystem::path folder_;
  std::string stem_;
  Of what_;
  bool stress_ = false;
  std::vector<Frame> frames_;
};

}  // namespace eigengrain::io
