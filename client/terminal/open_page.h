// Opens an address in the user's browser.
#ifndef PHRENIC_CLIENT_TERMINAL_OPEN_PAGE_H_
#define PHRENIC_CLIENT_TERMINAL_OPEN_PAGE_H_

#include <string>

#include "absl/status/status.h"

namespace phrenic::client {

// Starts xdg-open, the desktop's opener, or the program that $BROWSER names, and does not wait for it. The address is
// an argument, not text for a shell. NOT_FOUND, with the address and the remedy, if there is neither.
absl::Status OpenPage(const std::string& address);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_OPEN_PAGE_H_
