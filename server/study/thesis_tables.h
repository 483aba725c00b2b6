// Measurements of the thesis for comparison (2008, Java, dual core 2.4 GHz): iterations per second of
// figures 5.10, 5.12 and 5.24, and the cost of rigid links (5.27). Figure 5.24 is 100 iterations over the averages of
// figures 5.14-5.22; figure 5.12 is read in the same way. The print has two inconsistencies: the trials of figure 5.12
// without attachments equal those of figure 5.14 in full, and the patient's rates in figure 5.27 (10.40, 10.41, 10.39
// with links) differ from those in figure 5.24 (6.37, 12.05, 19.39).
#ifndef PHRENIC_SERVER_STUDY_THESIS_TABLES_H_
#define PHRENIC_SERVER_STUDY_THESIS_TABLES_H_

#include <optional>
#include <string>
#include <vector>

#include "phrenic/v1/scene.pb.h"

namespace phrenic::study {

// A measured rate with its source.
struct ThesisFigure {
  std::string what;  // "fig. 5.24, perfect model, high, 20909 vertices, with rigid links"
  double steps_per_second = 0;
};

// The part that was left out in a trial of the thesis.
enum class ThesisTrial { kFull, kNoLinks, kNoAttachments, kNoRibs, kNoMuscles };

// Returns the figure of that trial whose model corresponds to the scene: the cube for 8 vertices; a thorax for a scene
// with a diaphragm and half to twice the number of vertices. Returns nullopt if there is none.
std::optional<ThesisFigure> LikeThesisFigure(const v1::Scene& scene, int64_t vertices, ThesisTrial trial);

// One size of a model, with and without rigid links.
struct ThesisSize {
  const char* what;  // "perfect model, high"
  int vertices;
  int links;                         // 0 if the thesis does not state it
  double with_links, without_links;  // steps per second
  double percent;                    // cost of the links, as printed
  const char* figure;
};

// Returns the sizes of the model that corresponds to the scene: the cube, the patient or the perfect model; else none.
std::vector<ThesisSize> LikeThesisSizes(const v1::Scene& scene, int64_t vertices);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_THESIS_TABLES_H_
