// IFC, by web-ifc in a Node child process: ifc/read_ifc.mjs reads, ifc_answer.h tells what it answers.

#include <fstream>

#include "io/beside_program.h"
#include "io/formats/child_process.h"
#include "io/formats/ifc_answer.h"
#include "io/formats/model.h"
#include "io/formats/run_program.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = (2ull << 30) - 1;  // what Node reads at once
constexpr std::string_view kInstall = "bash apps/install_dependencies.sh";

/// "the first" and "the last" bytes of a file.
std::pair<std::string, std::string> ends_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(1024, '\0'), tail(65'536, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  in.clear();
  const auto bytes = std::filesystem::file_size(file);
  in.seekg(static_cast<std::streamoff>(bytes - std::min<std::uintmax_t>(bytes, tail.size())));
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  tail.resize(static_cast<std::size_t>(in.gcount()));
  return {head, tail};
}

/// What can be said before anything is started.
void refuse_what_is_no_step_file(const std::filesystem::path& file) {
  const auto [head, tail] = ends_of(file);
  const std::string name = short_name(file);
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff"))
    throw InputError(text(name, ": is UTF-16 text; IFC files are plain text (ISO 10303-21). Save it as UTF-8"));
  if (head.starts_with("PK\x03\x04"))
    throw InputError(text(name, ": is a zip archive (ifcZIP); unpack it and give the .ifc file in it"));
  if (head.find("<?xml") != head.npos || head.find("<ifc:") != head.npos)
    throw InputError(text(name, ": is XML (ifcXML); export it as a STEP file (.ifc)"));
  if (head.find("ISO-10303-21") == head.npos)
    throw InputError(text(name, ": cannot be read: it does not begin with ISO-10303-21; as IFC files do; ",
                          "the file is damaged or not what its name says. Export it again"));
  if (tail.find("END-ISO-10303-21") == tail.npos)
    throw InputError(
        text(name, ": is cut off: its last line END-ISO-10303-21; is missing; copy or export it ", "again"));
}

/// Beside the program, in the build tree as where it is installed; else where the library was installed.
std::filesystem::path reader_script(const std::string& name) {
  std::error_code error;
  const std::filesystem::path beside = beside_program(CLERESTORY_IFC_FOLDER);
  for (const std::filesystem::path& folder : {beside, std::filesystem::path(CLERESTORY_INSTALLED_IFC_FOLDER)})
    if (std::filesystem::exists(folder / "node_modules/web-ifc/package.json", error)) return folder / "read_ifc.mjs";
  throw InputError(text(name, ": IFC is read by web-ifc, which is not in ", beside.string(), "; to install it, run ",
                        kInstall, " in the source folder, then build again. Only .ifc needs it"));
}

std::string node(const std::string& name) {
  for (const char* program : {"node", "nodejs"})
    if (const std::string found = find_program(program); !found.empty()) return found;
  throw InputError(text(name, ": IFC is read by Node.js (18 or later), and there is no program 'node' in PATH; to ",
                        "install it, run ", kInstall, ", or apt-get install nodejs. Only .ifc needs it"));
}

}  // namespace

Model read_ifc(const std::filesystem::path& file) {
  check_input_file(file, kMaxBytes);
  const std::string name = short_name(file);
  refuse_what_is_no_step_file(file);
  const std::string program = node(name);
  const std::string script = reader_script(name).string();
  const std::uint64_t bytes = std::filesystem::file_size(file);
  // An honest megabyte takes well under a second and some 10 MB; the rest is for slow machines.
  const std::chrono::seconds seconds(30 + 5 * (bytes >> 20));
  const std::uint64_t memory = (1ull << 30) + 60 * bytes;
  // As much as the most faces take, each with three vertices of its own, and the names and numbers beside them.
  constexpr std::uint64_t kFaceBytes = 3 * sizeof(std::uint32_t) + 9 * sizeof(float);
  const ProgramLimits limits{.cpu_time = seconds,
                             .time = 2 * seconds,
                             .memory_bytes = memory,
                             .answer_bytes = kMaxFaces * kFaceBytes + (1u << 20) + 4 * bytes};
  const std::string heap = text("--max-old-space-size=", (memory >> 20) / 2);
  std::string answer;
  try {
    run_program({program, heap, "--no-warnings", script}, file, limits, answer);
    return model_of_ifc_answer(answer, file);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& failure) {
    // V8 reserves that much for a machine of WebAssembly, and fails in many ways where it cannot.
    constexpr std::uint64_t kAddressSpace = std::uint64_t{16} << 30;
    if (const auto allowed = address_space_limit(); allowed && *allowed < kAddressSpace)
      throw InputError(text(name, ": cannot be read: the .ifc importer, Node.js, takes some ", kAddressSpace >> 20,
                            " MiB of address space, and ", *allowed >> 20, " MiB are allowed (ulimit -v); allow more"));
    const std::string product = last_ifc_product(answer);
    throw InputError(text(name, ": cannot be read: the .ifc importer ", quotable(failure.what(), 200),
                          product.empty() ? "" : text(", at '", quotable(product), "'"),
                          "; the file is damaged, or too much for it. Try to export it again, as glTF or OBJ"));
  }
}

}  // namespace clerestory
