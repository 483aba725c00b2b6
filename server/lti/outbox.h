// Messages to other servers that must arrive: scores and statements. Repeats them until they do.
#ifndef PHRENIC_SERVER_LTI_OUTBOX_H_
#define PHRENIC_SERVER_LTI_OUTBOX_H_

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/jobs/records.h"

namespace phrenic::lti {

// A message that waits. Plain data; kept in the store as JSON.
struct Parcel {
  std::string id;               // a newer parcel of this id replaces an older one that has not arrived
  std::string receiver = "";    // key of a platform (Grading); empty: the store of learning records
  std::string address = "";     // of a score: the line item
  nlohmann::json content = {};  // the score or the statement
  int attempts = 0;
  absl::Time first = absl::InfinitePast();  // when it was added
};

// Thread-safe. One thread of its own delivers one parcel at a time. After an error it waits 1 s, then twice as long
// each time, an hour at most. With a store, parcels survive the server. What cannot be delivered is written to the log
// as an error: a parcel that is refused for good (INVALID_ARGUMENT), that is a week old, or that finds 10,000 others.
class Outbox {
 public:
  // Delivers one parcel; blocks. INVALID_ARGUMENT: a repeat would be refused as well.
  using Deliver = std::function<absl::Status(const Parcel& parcel)>;
  Outbox(Deliver deliver, jobs::Records records);
  // Ends the thread after the delivery in progress. Parcels stay in the store.
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void Add(Parcel parcel, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // Adds a parcel of an earlier server. INVALID_ARGUMENT if it is damaged.
  absl::Status Restore(const std::string& bytes) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the number of parcels that wait.
  std::size_t size() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Waiting {
    Parcel parcel;
    absl::Time due;
    std::uint64_t version = 0;  // tells a parcel from the one that replaced it while it was delivered
  };

  void Run() ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the parcel that is due next; end() if no parcel waits.
  std::map<std::string, Waiting>::iterator Next() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Removes or delays the parcel after an attempt.
  void Settle(const Waiting& tried, const absl::Status& outcome) ABSL_LOCKS_EXCLUDED(mutex_);
  void Save(const Parcel& parcel) const;

  const Deliver deliver_;
  const jobs::Records records_;
  mutable absl::Mutex mutex_;
  absl::CondVar changed_;
  std::map<std::string, Waiting> waiting_ ABSL_GUARDED_BY(mutex_);  // by id
  std::uint64_t versions_ ABSL_GUARDED_BY(mutex_) = 0;
  bool ended_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_OUTBOX_H_
