// Reads and writes fields of HTML forms and addresses (application/x-www-form-urlencoded), and text in HTML.
#ifndef PHRENIC_SERVER_LTI_FORM_H_
#define PHRENIC_SERVER_LTI_FORM_H_

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace phrenic::lti {

// Fields by name. All functions are pure and thread-safe.
using Fields = std::map<std::string, std::string, std::less<>>;

// Returns the fields; of a name that is given again, the last. Fields past the 100th and incomplete escapes are
// ignored.
Fields ReadForm(std::string_view text);
// Returns the value of a field; empty without one.
std::string FieldOf(const Fields& fields, std::string_view name);

// Returns "a=1&b=2".
std::string WriteForm(const std::vector<std::pair<std::string, std::string>>& fields);

// Returns the value of a cookie in the header Cookie; empty without it.
std::string CookieOf(std::string_view header, std::string_view name);

// Returns the text with the characters escaped that mean something in HTML text and in quoted attributes.
std::string HtmlText(std::string_view text);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_FORM_H_
