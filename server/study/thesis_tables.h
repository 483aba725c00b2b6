// What the thesis measured, for comparison (2008, Java, dual core 2.4 GHz): iterations a second of figures 5.10, 5.12
// and 5.24, and what rigid links cost (5.27). Figure 5.24 is 100 iterations over the averages of figures 5.14-5.22;
// figure 5.12 is read the same way. Two things are odd in the print: the trials of figure 5.12 without attachments are
// those of figure 5.14 in full, and figure 5.27 gives other rates of the patient (10.40, 10.41, 10.39 with links) than
// figure 5.24 (6.37, 12.05, 19.39).
#ifndef PHRENIC_SERVER_STUDY_THESIS_TABLES_H_
#define PHRENIC_SERVER_STUDY_THESIS_TABLES_H_

#include <optional>
#include <string>
#include <vector>

#include "phrenic/v1/report.pb.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic::study {

struct ThesisFigure {
  std::string what;  // "fig. 5.24, perfect model, high, 20909 vertices, with rigid links"
  double steps_per_second = 0;
};

// The figure whose model comes nearest to the scene in vertices, with or without rigid links as the scene has them: of
// the thesis' patient where the scene's soft bodies come from surface files, else of its cube and "perfect" models.
ThesisFigure NearestThesisFigure(const v1::Scene& scene, const v1::CompileReport& report);

// What was left out of a scene for a trial of the thesis.
enum class ThesisTrial { kFull, kNoLinks, kNoAttachments, kNoRibs, kNoMuscles };

// The figure of that trial that is like the scene: the cube for 8 vertices, a thorax for a scene with a diaphragm and
// at most twice or half its vertices. Nothing where there is none.
std::optional<ThesisFigure> LikeThesisFigure(const v1::Scene& scene, int64_t vertices, ThesisTrial trial);

// One size of a model with rigid links and without.
struct ThesisSize {
  const char* what;  // "perfect model, high"
  int vertices;
  int links;  // 0 where the thesis does not say
  double with_links, without_links;
  double percent;  // as printed: what the links cost
  const char* figure;
};

// Those of the model that the scene is like: the cube, the patient, the perfect model or none.
std::vector<ThesisSize> LikeThesisSizes(const v1::Scene& scene, int64_t vertices);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_THESIS_TABLES_H_
