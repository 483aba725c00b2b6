// Annotates Abseil's mutexes for ThreadSanitizer. Debian's Abseil is not instrumented, so the sanitizer would report
// every access to a guarded member. The linker's --wrap (CMakeLists.txt) redirects the calls of Phrenic's code to this
// file. Functions that are not wrapped (CondVar, TryLock of readers) are not used; they would cause false reports.
#include <sanitizer/tsan_interface.h>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "absl/time/time.h"

extern "C" {
void AnnotateIgnoreReadsBegin(const char* file, int line);
void AnnotateIgnoreReadsEnd(const char* file, int line);
}

namespace {

using absl::Condition;
using absl::Mutex;
using absl::Notification;

// Another thread may evaluate a condition inside Unlock or its own Await, when the lock is held although the sanitizer
// regards it as released. The waiting thread removes the condition from its stack only afterwards. By a pointer to
// void, Abseil itself reads the outer condition, uninstrumented; a typed one would be read by code of its header.
bool EvalQuietly(void* condition) {
  AnnotateIgnoreReadsBegin(__FILE__, __LINE__);
  const bool holds = static_cast<Condition*>(condition)->Eval();
  AnnotateIgnoreReadsEnd(__FILE__, __LINE__);
  __tsan_release(condition);
  return holds;
}

// Waits for a condition that is evaluated without reports.
template <typename Wait>
bool Waiting(Mutex* mutex, const Condition& condition, const Wait& wait) {
  Condition waited_for = condition;
  const Condition quiet(&EvalQuietly, static_cast<void*>(&waited_for));
  __tsan_release(mutex);
  const bool holds = wait(quiet);
  __tsan_acquire(mutex);
  __tsan_acquire(&waited_for);
  return holds;
}

}  // namespace

#define PHRENIC_MUTEX(name) "_ZN4absl7debian35Mutex" name
#define PHRENIC_CONDITION "ERKNS0_9ConditionE"

void RealLock(Mutex* mutex) asm("__real_" PHRENIC_MUTEX("4LockEv"));
void RealUnlock(Mutex* mutex) asm("__real_" PHRENIC_MUTEX("6UnlockEv"));
bool RealTryLock(Mutex* mutex) asm("__real_" PHRENIC_MUTEX("7TryLockEv"));
void RealAwait(Mutex* mutex, const Condition& condition) asm("__real_" PHRENIC_MUTEX("5Await" PHRENIC_CONDITION));
bool RealAwaitWithDeadline(Mutex* mutex, const Condition& condition,
                           absl::Time deadline) asm("__real_" PHRENIC_MUTEX("17AwaitWithDeadline" PHRENIC_CONDITION
                                                                            "NS0_4TimeE"));
bool RealAwaitWithTimeout(Mutex* mutex, const Condition& condition,
                          absl::Duration timeout) asm("__real_" PHRENIC_MUTEX("16AwaitWithTimeout" PHRENIC_CONDITION
                                                                              "NS0_8DurationE"));
void RealNotify(Notification* notification) asm("__real__ZN4absl7debian312Notification6NotifyEv");
void RealWait(const Notification* notification) asm("__real__ZNK4absl7debian312Notification19WaitForNotificationEv");
bool RealWaitFor(const Notification* notification, absl::Duration timeout) asm(
    "__real__ZNK4absl7debian312Notification30WaitForNotificationWithTimeoutENS0_8DurationE");

void WrapLock(Mutex* mutex) asm("__wrap_" PHRENIC_MUTEX("4LockEv"));
void WrapUnlock(Mutex* mutex) asm("__wrap_" PHRENIC_MUTEX("6UnlockEv"));
bool WrapTryLock(Mutex* mutex) asm("__wrap_" PHRENIC_MUTEX("7TryLockEv"));
void WrapAwait(Mutex* mutex, const Condition& condition) asm("__wrap_" PHRENIC_MUTEX("5Await" PHRENIC_CONDITION));
bool WrapAwaitWithDeadline(Mutex* mutex, const Condition& condition,
                           absl::Time deadline) asm("__wrap_" PHRENIC_MUTEX("17AwaitWithDeadline" PHRENIC_CONDITION
                                                                            "NS0_4TimeE"));
bool WrapAwaitWithTimeout(Mutex* mutex, const Condition& condition,
                          absl::Duration timeout) asm("__wrap_" PHRENIC_MUTEX("16AwaitWithTimeout" PHRENIC_CONDITION
                                                                              "NS0_8DurationE"));
void WrapNotify(Notification* notification) asm("__wrap__ZN4absl7debian312Notification6NotifyEv");
void WrapWait(const Notification* notification) asm("__wrap__ZNK4absl7debian312Notification19WaitForNotificationEv");
bool WrapWaitFor(const Notification* notification, absl::Duration timeout) asm(
    "__wrap__ZNK4absl7debian312Notification30WaitForNotificationWithTimeoutENS0_8DurationE");

void WrapLock(Mutex* mutex) {
  RealLock(mutex);
  __tsan_acquire(mutex);
}

void WrapUnlock(Mutex* mutex) {
  __tsan_release(mutex);
  RealUnlock(mutex);
}

bool WrapTryLock(Mutex* mutex) {
  const bool locked = RealTryLock(mutex);
  if (locked) __tsan_acquire(mutex);
  return locked;
}

void WrapAwait(Mutex* mutex, const Condition& condition) {
  Waiting(mutex, condition, [&](const Condition& quiet) {
    RealAwait(mutex, quiet);
    return true;
  });
}

bool WrapAwaitWithDeadline(Mutex* mutex, const Condition& condition, absl::Time deadline) {
  return Waiting(mutex, condition,
                 [&](const Condition& quiet) { return RealAwaitWithDeadline(mutex, quiet, deadline); });
}

bool WrapAwaitWithTimeout(Mutex* mutex, const Condition& condition, absl::Duration timeout) {
  return Waiting(mutex, condition, [&](const Condition& quiet) { return RealAwaitWithTimeout(mutex, quiet, timeout); });
}

void WrapNotify(Notification* notification) {
  __tsan_release(notification);
  RealNotify(notification);
}

void WrapWait(const Notification* notification) {
  RealWait(notification);
  __tsan_acquire(const_cast<Notification*>(notification));
}

bool WrapWaitFor(const Notification* notification, absl::Duration timeout) {
  const bool notified = RealWaitFor(notification, timeout);
  if (notified) __tsan_acquire(const_cast<Notification*>(notification));
  return notified;
}
