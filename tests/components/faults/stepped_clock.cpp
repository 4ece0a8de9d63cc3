// Preloaded into the participants: the clock of a computer on which somebody sets the time. It is
// off by as many nanoseconds as the file says that SWIVEL_STEPPED_CLOCK names, in all of them at
// once; what counts from the boot, as steady clocks do, is not.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
using Offset = std::atomic<std::int64_t>;

const Offset* map_offset() {
  const char* const path = std::getenv("SWIVEL_STEPPED_CLOCK");
  const int file = path == nullptr ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) std::abort();  // the test would see nothing
  void* const mapped = mmap(nullptr, sizeof(Offset), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  if (mapped == MAP_FAILED) std::abort();
  return static_cast<const Offset*>(mapped);
}

std::int64_t offset_ns() {
  static const Offset* const offset = map_offset();
  return *offset;
}

timespec moved(const timespec& time, std::int64_t by_ns) {
  const std::int64_t moved_ns = time.tv_sec * kSecond_ns + time.tv_nsec + by_ns;
  return {moved_ns / kSecond_ns, moved_ns % kSecond_ns};
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
  const auto error = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  if (error == 0 && clock == CLOCK_REALTIME) *time = moved(*time, offset_ns());
  return error;
}

extern "C" int gettimeofday(timeval* time, void*) {
  timespec now{};
  if (clock_gettime(CLOCK_REALTIME, &now) != 0) return -1;
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

extern "C" time_t time(time_t* seconds) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (seconds != nullptr) *seconds = now.tv_sec;
  return now.tv_sec;
}

namespace {

// The kernel waits by its own clock. Much counts from the boot instead, and is left alone: no
// computer runs for 30 years.
timespec by_the_kernel(const timespec& until) {
  const bool since_boot = until.tv_sec < 1'000'000'000;
  return since_boot ? until : moved(until, -offset_ns());
}

}  // namespace

extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* until) {
  using Wait = int (*)(pthread_cond_t*, pthread_mutex_t*, const timespec*);
  static const Wait wait = reinterpret_cast<Wait>(dlsym(RTLD_NEXT, "pthread_cond_timedwait"));
  const timespec true_until = by_the_kernel(*until);
  return wait(condition, mutex, &true_until);
}

extern "C" int sem_timedwait(sem_t* semaphore, const timespec* until) {
  using Wait = int (*)(sem_t*, const timespec*);
  static const Wait wait = reinterpret_cast<Wait>(dlsym(RTLD_NEXT, "sem_timedwait"));
  const timespec true_until = by_the_kernel(*until);
  return wait(semaphore, &true_until);
}
