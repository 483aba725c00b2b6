// A study of people's motion as a self-contained HTML page.
#ifndef PHRENIC_CLIENT_PRINT_MOTION_PAGE_H_
#define PHRENIC_CLIENT_PRINT_MOTION_PAGE_H_

#include <string>

#include "server/fit/motion_study.h"

namespace phrenic::client {

// Returns the page: the table of errors, and for each person two plots of the held-out landmarks, the caudal motion
// over the height, measured and fitted, and a view from the side, coloured by the error. Text from files is escaped.
std::string MotionPage(const fit::MotionStudy& study);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_MOTION_PAGE_H_
