// Attacks on what belongs to another account: uploads, studies, sessions.
#include <algorithm>
#include <random>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "phrenic/v1/upload.grpc.pb.h"
#include "server/crypto/sha256.h"
#include "tests/faults/attacks.h"

namespace phrenic::faults {
namespace {

constexpr char kTetrahedron[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// The calls of one account to its own or another's uploads.
class Uploader {
 public:
  Uploader(const Victim& victim, std::string account)
      : victim_(victim), account_(std::move(account)), stub_(v1::UploadService::NewStub(victim.NewChannel())) {}

  v1::BeginUploadResponse Begin(const std::string& bytes) {
    v1::BeginUploadRequest request;
    request.set_name("a.obj");
    request.set_size(static_cast<std::int64_t>(bytes.size()));
    request.set_sha256(Sha256Hex(bytes));
    v1::BeginUploadResponse response;
    Ask(&v1::UploadService::Stub::BeginUpload, request, response);
    return response;
  }
  bool Add(const std::string& id, std::int64_t offset, const std::string& chunk) {
    v1::AddUploadChunkRequest request;
    request.set_upload_id(id);
    request.set_offset(offset);
    request.set_chunk(chunk);
    v1::AddUploadChunkResponse response;
    return Ask(&v1::UploadService::Stub::AddUploadChunk, request, response);
  }
  bool Finish(const std::string& id, std::string* path = nullptr) {
    v1::FinishUploadRequest request;
    request.set_upload_id(id);
    v1::FinishUploadResponse response;
    const bool good = Ask(&v1::UploadService::Stub::FinishUpload, request, response);
    if (path != nullptr) *path = response.file().path();
    return good;
  }
  bool Delete(const std::string& path) {
    v1::DeleteUploadRequest request;
    request.set_path(path);
    v1::DeleteUploadResponse response;
    return Ask(&v1::UploadService::Stub::DeleteUpload, request, response);
  }
  bool Lists(const std::string& path) {
    v1::ListUploadsResponse response;
    Ask(&v1::UploadService::Stub::ListUploads, v1::ListUploadsRequest(), response);
    return std::ranges::any_of(response.files(), [&](const auto& file) { return file.path() == path; });
  }
  // Uploads a file. Returns its path; empty if that is refused.
  std::string Upload(const std::string& bytes) {
    const auto begun = Begin(bytes);
    std::string path;
    if (begun.has_file()) return begun.file().path();
    constexpr std::size_t kChunk = 1U << 20;
    for (std::size_t at = 0; at < bytes.size(); at += kChunk) {
      if (!Add(begun.upload_id(), static_cast<std::int64_t>(at), bytes.substr(at, kChunk))) return "";
    }
    Finish(begun.upload_id(), &path);
    return path;
  }

 private:
  template <class Request, class Response>
  bool Ask(grpc::Status (v1::UploadService::Stub::*method)(grpc::ClientContext*, const Request&, Response*),
           const Request& request, Response& response) {
    grpc::ClientContext context;
    victim_.Sign(account_, context, 20);
    return (*stub_.*method)(&context, request, &response).ok();
  }

  const Victim& victim_;
  const std::string account_;
  const std::unique_ptr<v1::UploadService::Stub> stub_;
};

// Returns a valid surface file of about `size` bytes, different for each `number`.
std::string SurfaceFile(int number, std::size_t size) {
  return absl::StrCat("# ", number, std::string(size, ' '), "\n", kTetrahedron);
}

// Returns an id near a known one, or one that a counter would give.
std::string GuessedId(const std::string& known, int guess, std::mt19937& random) {
  if (guess % 2 == 0 || known.empty()) return absl::StrCat("u", guess / 2);
  std::string id = known;
  id.back() = static_cast<char>('0' + random() % 10);
  return id;
}

// True if the token has the name in clear or in base64.
bool Names(const std::string& token, const std::string& name) {
  std::string bytes;
  if (absl::StrContains(token, name)) return true;
  if (absl::Base64Unescape(token, &bytes) && absl::StrContains(bytes, name)) return true;
  return absl::WebSafeBase64Unescape(token, &bytes) && absl::StrContains(bytes, name);
}

// Lists one page. Returns the status; the response in `listed`.
grpc::Status ListPage(const Victim& victim, v1::SessionService::Stub& stub, const std::string& account,
                      const std::string& page_token, const std::string& join, v1::ListSessionsResponse& listed) {
  v1::ListSessionsRequest request;
  request.set_page_size(1);
  request.set_page_token(page_token);
  grpc::ClientContext context;
  victim.Sign(account, context);
  if (!join.empty()) context.AddMetadata("x-join", join);
  return stub.ListSessions(&context, request, &listed);
}

}  // namespace

Outcome UploadTheft(const Victim& victim, int times) {
  Uploader healthy(victim, "healthy"), thief(victim, "thief");
  Outcome outcome;
  const std::string secret = SurfaceFile(1, 1000), unfinished = SurfaceFile(2, 1000);
  const std::string path = healthy.Upload(secret);
  const std::string id = healthy.Begin(unfinished).upload_id();
  if (path.empty() || id.empty()) outcome.broken.emplace_back("a healthy account cannot upload");
  std::mt19937 random(7);
  for (int i = 0; i < times && victim.Continues(); ++i) {
    const std::string guess = i == 0 ? id : GuessedId(id, i, random);
    const bool added = thief.Add(guess, 0, "stolen"), finished = thief.Finish(guess);
    outcome.tried += 2;
    outcome.served += (added ? 1 : 0) + (finished ? 1 : 0);
    outcome.refused += (added ? 0 : 1) + (finished ? 0 : 1);
  }
  if (outcome.served > 0) outcome.broken.emplace_back("another account's upload was changed");
  if (thief.Begin(secret).has_file() || thief.Lists(path))
    outcome.broken.emplace_back("a hash was enough to own a file");
  if (thief.Delete(path) || !healthy.Lists(path)) outcome.broken.emplace_back("another account's file was deleted");
  for (int i = 0; i < 8 && victim.Continues(); ++i) thief.Upload(SurfaceFile(10 + i, 3U << 20));
  if (!healthy.Lists(path)) outcome.broken.emplace_back("uploads of one account evicted another's file");
  return outcome;
}

Outcome StudyFlood(const Victim& victim, int times) {
  const auto stub = v1::StudyService::NewStub(victim.NewChannel());
  const auto create = [&](const std::string& account, const std::string& id) {
    v1::CreateStudyRequest request;
    request.set_study_id(id);
    request.mutable_source()->set_name("cube-springs");
    request.mutable_cost()->set_steps(1);
    v1::CreateStudyResponse response;
    grpc::ClientContext context;
    victim.Sign(account, context, 20);
    return stub->CreateStudy(&context, request, &response).ok();
  };
  const auto lists = [&](const std::string& account) {
    v1::ListStudiesResponse response;
    grpc::ClientContext context;
    victim.Sign(account, context, 20);
    const bool good = stub->ListStudies(&context, {}, &response).ok();
    return good && std::ranges::any_of(response.studies(), [](const auto& study) { return study.id() == "precious"; });
  };
  Outcome outcome;
  if (!create("healthy", "precious")) outcome.broken.emplace_back("a healthy account cannot create a study");
  for (int i = 0; i < times && victim.Continues(); ++i) {
    ++outcome.tried;
    ++(create("greedy", absl::StrCat("flood-", i)) ? outcome.served : outcome.refused);
    v1::DeleteStudyRequest remove;
    remove.set_study_id(absl::StrCat("flood-", i));
    v1::DeleteStudyResponse removed;
    grpc::ClientContext context;
    victim.Sign("greedy", context, 20);
    (void)stub->DeleteStudy(&context, remove, &removed);
  }
  if (!lists("healthy")) outcome.broken.emplace_back("the owner lost its study");
  if (lists("thief")) outcome.broken.emplace_back("another account sees the study");
  return outcome;
}

Outcome ForgedTokens(const Victim& victim, int times) {
  constexpr char kHidden[] = "anna-mueller";
  const auto stub = v1::SessionService::NewStub(victim.NewChannel());
  const auto create = [&](const std::string& account, const std::string& id) {
    return victim.CreateSession(account, id).ok();
  };
  Outcome outcome;
  if (!create("healthy", kHidden) || !create("thief", "aaa") || !create("thief", "zzz"))
    outcome.broken.emplace_back("no sessions");
  v1::ListSessionsResponse listed;
  std::string page;
  bool named = false;
  for (int pages = 0; pages < 6; ++pages) {
    if (!ListPage(victim, *stub, "thief", page, "", listed).ok()) break;
    page = listed.next_page_token();
    named = named || Names(page, kHidden) || Names(page, Victim::kWatched);
    if (page.empty()) break;
  }
  if (named) outcome.broken.emplace_back("a page token names a hidden session");
  std::mt19937 random(5);
  int garbage_pages = 0, garbage_links = 0;
  for (int i = 0; i < times && victim.Continues(); ++i) {
    std::string garbage(1 + random() % 60, ' ');
    for (char& c : garbage) c = static_cast<char>('!' + random() % 94);
    const bool paged = ListPage(victim, *stub, "thief", garbage, "", listed).ok();
    const grpc::Status joined =
        ListPage(victim, *stub, "", "", garbage, listed);  // beside an account, the account counts
    const bool admitted = joined.error_code() != grpc::UNAUTHENTICATED;
    outcome.tried += 2;
    outcome.served += (paged ? 1 : 0) + (admitted ? 1 : 0);
    outcome.refused += (paged ? 0 : 1) + (admitted ? 0 : 1);
    garbage_pages += paged ? 1 : 0, garbage_links += admitted ? 1 : 0;
  }
  if (garbage_pages > 0) outcome.broken.push_back(absl::StrCat(garbage_pages, " invented page tokens passed"));
  if (garbage_links > 0) outcome.broken.push_back(absl::StrCat(garbage_links, " invented links passed"));
  return outcome;
}

}  // namespace phrenic::faults
