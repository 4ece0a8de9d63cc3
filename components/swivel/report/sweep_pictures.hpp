// The close pictures of each sweep, in a folder: its walls, its seam, its plate. Its views from
// above are the output folder's.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "components/common/rig_file.hpp"
#include "components/swivel/offline/processed_sweep.hpp"
#include "components/swivel/pictures/pictures.hpp"
#include "components/swivel/report/surfaces.hpp"

namespace swivel {

class SweepPictures {
 public:
  // The folder must be there. title: what was scanned.
  SweepPictures(std::string folder, std::string title, RigFile rig);

  // Of the sweep's cloud. Throws ExitError.
  std::vector<Surface> surfaces_of(const ProcessedSweep& processed) const;
  void draw(const ProcessedSweep& processed, const std::vector<Surface>& surfaces);

  std::string path(const std::string& kind, std::size_t sweep) const;
  bool is_drawn(const std::string& path) const { return drawn_.count(path) > 0; }

 private:
  PictureCaption caption_of(const ProcessedSweep& processed) const;
  void draw_plate(const ProcessedSweep& processed, const PictureCaption& caption);

  std::string folder_;
  std::string title_;
  RigFile rig_;
  std::set<std::string> drawn_;  // paths
};

}  // namespace swivel
