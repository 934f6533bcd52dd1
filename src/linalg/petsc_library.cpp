#include "linalg/petsc_library.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <slepcsys.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/run_clock.hpp"
#include "linalg/petsc_running.hpp"
#include "system/worker_process.hpp"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace fw::linalg {

namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// What PETSc has said since the last failure that was told; guarded by the lock.
std::string& said() {
  static std::string text;
  return text;
}

constexpr std::size_t longest_message = 2000;

/// Keeps the first message of a failure and the functions it has passed.
PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  std::string& text = said();
  if (type == PETSC_ERROR_INITIAL) {
    const char* meaning = nullptr;
    PetscErrorMessage(code, &meaning, nullptr);
    text = fmt::format("{}: {} (PETSc error {}: {})", function == nullptr ? "unknown function" : function,
                       message == nullptr ? "" : message, static_cast<int>(code),
                       meaning == nullptr ? "unknown" : meaning);
  } else if (function != nullptr && text.size() < longest_message) {
    text += fmt::format(" < {}", function);
  }
  return code;
}

/// While it lives, what is allocated counts as no leak: Open MPI keeps memory of its plugins beyond its end.
class StartAndEndOfMpi {
#ifdef __SANITIZE_ADDRESS__
  __lsan::ScopedDisabler quiet_;
#endif
};

/// PETSc and SLEPc from the first use to the end of the program.
class Library {
 public:
  Library() {
    const LibraryStart start;
    [[maybe_unused]] const StartAndEndOfMpi quiet;
    static char name[] = "federwerk", no_file[] = "-skip_petscrc", no_signals[] = "-no_signal_handler";
    static char* words[] = {name, no_file, no_signals, nullptr};
    static char** arguments = words;
    static int count = 3;
    int is_ended = 0;
    MPI_Finalized(&is_ended);
    if (is_ended != 0) throw SystemError("PETSc cannot start: MPI has been ended in this process");
    // Without a launcher Open MPI would start a daemon beside the program, which nothing here needs.
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    // Threads call one at a time.
    PETSC_MPI_THREAD_REQUIRED = MPI_THREAD_SERIALIZED;
    PetscErrorCode code = SlepcInitialize(&count, &arguments, nullptr, nullptr);
    if (code == 0) code = PetscPushErrorHandler(keep_message, nullptr);
    // Types are registered now, while PETSc's own options are the ones that are read.
    for (auto* register_types :
         {PCInitializePackage, KSPInitializePackage, SNESInitializePackage, TSInitializePackage}) {
      if (code == 0) code = register_types();
    }
    if (code != 0) throw SystemError(fmt::format("PETSc cannot start: error {}", static_cast<int>(code)));
  }
  ~Library() {
    [[maybe_unused]] const StartAndEndOfMpi quiet;
    int is_ended = 0;
    MPI_Finalized(&is_ended);
    if (is_ended != 0) return;
    PetscPopErrorHandler();
    SlepcFinalize();
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

void start_library() {
  library_mutex();
  said();  // both outlive the library
  static const Library library;
}

bool ends_with(const std::string& name, std::string_view end) {
  return name.size() >= end.size() && std::string_view(name).substr(name.size() - end.size()) == end;
}

/// Types and numbers of the commonest options, looked at before any object reads them: PETSc 3.18 loses the
/// memory of its menu when a value in it is refused. `options` are a copy, since a look counts as use.
void check_values(PetscOptions options, const std::vector<std::string>& names) {
  const std::pair<const char*, PetscFunctionList> type_lists[] = {
      {"ksp_type", KSPList}, {"pc_type", PCList}, {"snes_type", SNESList}, {"ts_type", TSList}};
  for (const std::string& name : names) {
    for (const auto& [end, list] : type_lists) {
      char value[PETSC_MAX_PATH_LEN] = "";
      PetscBool is_set = PETSC_FALSE;
      if (!ends_with(name, end)) continue;
      petsc_check(PetscOptionsGetString(options, nullptr, name.c_str(), value, sizeof(value), &is_set));
      void (*found)(void) = nullptr;
      petsc_check(PetscFunctionListFind(list, value, &found));
      if (found == nullptr) {
        throw PetscFailure(PETSC_ERR_ARG_UNKNOWN_TYPE, fmt::format("{}: unknown type \"{}\"", name, value));
      }
    }
    if (ends_with(name, "ts_adapt_type")) {
      char value[PETSC_MAX_PATH_LEN] = "";
      petsc_check(PetscOptionsGetString(options, nullptr, name.c_str(), value, sizeof(value), nullptr));
      const std::string_view types[] = {TSADAPTNONE, TSADAPTBASIC, TSADAPTDSP,
                                        TSADAPTCFL,  TSADAPTGLEE,  TSADAPTHISTORY};
      if (std::find(std::begin(types), std::end(types), value) == std::end(types)) {
        throw PetscFailure(PETSC_ERR_ARG_UNKNOWN_TYPE, fmt::format("{}: unknown type \"{}\"", name, value));
      }
    }
    for (const char* end : {"_rtol", "_atol", "_stol", "_divtol"}) {
      PetscReal value = 0.0;
      if (ends_with(name, end))
        petsc_check(PetscOptionsGetReal(options, nullptr, name.c_str(), &value, nullptr));
    }
    for (const char* end : {"_max_it", "_restart", "_levels", "_max_reject", "_max_snes_failures"}) {
      PetscInt value = 0;
      if (ends_with(name, end))
        petsc_check(PetscOptionsGetInt(options, nullptr, name.c_str(), &value, nullptr));
    }
  }
}

/// Throws InputError for an option that makes PETSc print between our lines, write or read files, or wait for a
/// debugger: none of them changes a result. Names are taken apart at "_", since objects have prefixes.
void refuse_side_effects(const std::string& text, const std::vector<std::string>& names) {
  constexpr std::string_view parts[] = {"help",    "monitor",   "view",     "viewer", "draw",       "plot",
                                        "print",   "log",       "info",     "dump",   "debugger",   "debug",
                                        "history", "citations", "saws",     "test",   "trajectory", "save",
                                        "load",    "file",      "filename", "python", "version"};
  constexpr std::string_view endings[] = {"converged_reason", "converged_rate", "compute_eigenvalues",
                                          "compute_singularvalues"};
  constexpr std::string_view starts[] = {"-options_", "-prefix_", "-malloc",
                                         "-on_error", "-memory",  "-objects"};
  for (const std::string& name : names) {
    std::istringstream words(name.substr(1));
    bool is_refused = false;
    for (std::string part; std::getline(words, part, '_');) {
      is_refused = is_refused || std::ranges::find(parts, std::string_view(part)) != std::end(parts);
    }
    for (const std::string_view end : endings) is_refused = is_refused || ends_with(name, end);
    for (const std::string_view start : starts) is_refused = is_refused || name.starts_with(start);
    if (!is_refused) continue;
    throw InputError(fmt::format(
        "PETSc options \"{}\": {} prints, writes or reads files beside the results, expected options of "
        "solvers and "
        "preconditioners only; the environment variable PETSC_OPTIONS takes those of the whole library",
        text, name));
  }
}

}  // namespace

void petsc_check(PetscErrorCode code) {
  if (code == 0) return;
  std::string what = std::exchange(said(), {});
  if (what.empty()) what = fmt::format("PETSc error {}", static_cast<int>(code));
  throw PetscFailure(code, what);
}

Status status_of(const PetscFailure& failure) {
  switch (failure.code()) {
    case PETSC_ERR_MAT_LU_ZRPVT:
      return {StatusCode::matrix_singular, failure.what()};
    case PETSC_ERR_MAT_CH_ZRPVT:
      return {StatusCode::matrix_indefinite, failure.what()};
    case PETSC_ERR_FP:
      return {StatusCode::non_finite, failure.what()};
    case PETSC_ERR_CONV_FAILED:
    case PETSC_ERR_NOT_CONVERGED:
      return {StatusCode::linear_solver_failed, failure.what()};
    case PETSC_ERR_LIB:
      // KLU's interface tells nothing more; values have been found finite before.
      if (std::string_view(failure.what()).starts_with("MatLUFactorNumeric_KLU")) {
        return {StatusCode::matrix_singular, failure.what()};
      }
      break;
    default:
      break;
  }
  return {StatusCode::library_failure, failure.what()};
}

bool is_bad_option(const PetscFailure& failure) {
  return failure.code() == PETSC_ERR_ARG_UNKNOWN_TYPE || failure.code() == PETSC_ERR_ARG_OUTOFRANGE ||
         failure.code() == PETSC_ERR_ARG_WRONG || failure.code() == PETSC_ERR_USER_INPUT;
}

namespace detail {

bool petsc_is_running() {
  PetscBool started = PETSC_FALSE, ended = PETSC_FALSE;
  PetscInitialized(&started);
  PetscFinalized(&ended);
  return started == PETSC_TRUE && ended == PETSC_FALSE;
}

void throw_bad_option(const PetscOptionText& options, const PetscFailure& failure) {
  throw InputError(fmt::format("PETSc options \"{}\": {}", options.text(), failure.what()));
}

}  // namespace detail

PetscOptionText::PetscOptionText(const std::string& text) : text_(text) {
  const PetscSession session;
  std::istringstream words(text);
  bool value_may_follow = false;
  std::vector<std::string> names;
  struct Copy {
    PetscOptions options = nullptr;
    ~Copy() { PetscOptionsDestroy(&options); }
  } copy;
  for (std::string word; words >> word;) {
    PetscBool is_name = PETSC_FALSE;
    petsc_check(PetscOptionsValidKey(word.c_str(), &is_name));
    if (is_name == PETSC_FALSE && !value_may_follow) {
      throw InputError(fmt::format("PETSc options \"{}\": found \"{}\", expected an option such as -ksp_type",
                                   text, word));
    }
    value_may_follow = is_name == PETSC_TRUE;
    if (is_name == PETSC_TRUE) names.push_back(word);
  }
  refuse_side_effects(text, names);
  try {
    const auto parse = [&](PetscOptions* into) {
      petsc_check(PetscOptionsCreate(into));
      petsc_check(PetscOptionsInsertString(*into, text.c_str()));
    };
    parse(&copy.options);
    check_values(copy.options, names);
    parse(&options_);
  } catch (const PetscFailure& failure) {
    PetscOptionsDestroy(&options_);
    detail::throw_bad_option(*this, failure);
  }
}

bool petsc_is_running() {
  return detail::petsc_is_running();
}

void check_petsc_options(const std::string& text) {
  if (text.empty()) return;
  if (detail::petsc_is_running()) {
    const PetscOptionText checked(text);
    return;
  }
  const std::string message = answer_of_a_process([&]() -> std::string {
    try {
      const PetscOptionText checked(text);
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  });
  if (!message.empty()) throw InputError(message);
}

PetscOptionText::~PetscOptionText() {
  if (!detail::petsc_is_running()) return;
  const PetscSession session;
  PetscOptionsDestroy(&options_);
}

bool PetscOptionText::has(const std::string& name) const {
  std::istringstream words(text_);
  for (std::string word; words >> word;) {
    if (word == name) return true;
  }
  return false;
}

void PetscOptionText::check_all_used() const {
  const PetscSession session;
  PetscInt count = 0;
  char** names = nullptr;
  char** values = nullptr;
  petsc_check(PetscOptionsLeftGet(options_, &count, &names, &values));
  const std::string first = count > 0 ? names[0] : "";
  petsc_check(PetscOptionsLeftRestore(options_, &count, &names, &values));
  if (first.empty()) return;
  throw InputError(
      fmt::format("PETSc options \"{}\": nobody has asked for -{}; it is unknown, or belongs to a solver "
                  "that is not used",
                  text_, first));
}

PetscSession::PetscSession(const PetscOptionText* options) : lock_(library_mutex()) {
  start_library();
  if (!detail::petsc_is_running()) throw SystemError("PETSc has been ended in this process");
  if (options == nullptr) return;
  petsc_check(PetscOptionsPush(options->options_));
  pushed_ = true;
}

PetscSession::~PetscSession() {
  if (pushed_) PetscOptionsPop();
}

}  // namespace fw::linalg
