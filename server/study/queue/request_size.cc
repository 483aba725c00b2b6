#include "server/study/queue/request_size.h"

#include <cstddef>
#include <string>

#include "absl/strings/str_cat.h"

namespace phrenic::study {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr int kMostEntries = 256;
constexpr std::size_t kMostBytes = 16 << 20;

// Lists inside the entries of a list are not looked at: kMostBytes bounds them.
absl::Status CheckLists(const Message& message, const std::string& path) {
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (!field.is_repeated() || reflection.FieldSize(message, &field) <= kMostEntries) continue;
    return absl::InvalidArgumentError(absl::StrCat(path, ".", field.name(), ": has ",
                                                   reflection.FieldSize(message, &field),
                                                   " entries, and a study takes at most ", kMostEntries));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckSize(const v1::CreateStudyRequest& request) {
  const auto* what = request.GetDescriptor()->FindOneofByName("what");
  const FieldDescriptor* study = request.GetReflection()->GetOneofFieldDescriptor(request, what);
  if (study != nullptr) {
    absl::Status lists = CheckLists(request.GetReflection()->GetMessage(request, study), study->name());
    if (!lists.ok()) return lists;
  }
  const std::size_t bytes = request.SpaceUsedLong();
  if (bytes <= kMostBytes) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrCat("source.scene: the request takes ", bytes, " bytes of memory, and that of a study at most ",
                   kMostBytes, ": name a shipped scene, or upload its surfaces and name their files"));
}

}  // namespace phrenic::study
