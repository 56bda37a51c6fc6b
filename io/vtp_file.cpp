#include "io/vtp_file.h"

#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <string>

#include <vtkNew.h>
#include <vtkOutputStream.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "io/atomic_file.h"
#include "solver/model/error.h"

namespace clerestory {

float to_float(double value, const char* array, std::size_t i) {
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    throw std::runtime_error(std::string(array) + "[" + std::to_string(i) + "] = " + std::to_string(value) +
                             " is not a number a result can hold");
  return static_cast<float>(value);
}

// Double, because georeferenced models lie 1e6 m from the origin.
void set_points(vtkPolyData* data, const std::vector<Vec3>& local, const Vec3& origin) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(id(local.size()));
  for (std::size_t i = 0; i < local.size(); ++i) {
    const Vec3 p = local[i] + origin;
    points->SetPoint(id(i), p.x, p.y, p.z);
  }
  data->SetPoints(points);
}

namespace {

/// Bytes on their way to a file. What cannot be written is lost silently, and told at the end: VTK 9.1 crashes when a
/// write fails in the middle of its own files.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(AtomicFile& file) : file_(file) {}

  /// throws  what writing threw.
  void finish() {
    flush();
    if (problem_) std::rethrow_exception(problem_);
  }

 protected:
  int_type overflow(int_type c) override {
    if (c == traits_type::eof()) return traits_type::not_eof(c);
    const char byte = traits_type::to_char_type(c);
    xsputn(&byte, 1);
    return c;
  }
  std::streamsize xsputn(const char* bytes, std::streamsize n) override {
    waiting_.append(bytes, static_cast<std::size_t>(n));
    if (waiting_.size() >= kBlock) flush();
    return n;
  }
  pos_type seekoff(off_type off, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type at = static_cast<off_type>(begin_ + waiting_.size());
    return off == 0 && from == std::ios_base::cur ? pos_type(at) : pos_type(off_type(-1));
  }
  pos_type seekpos(pos_type to, std::ios_base::openmode) override {
    flush();
    begin_ = static_cast<std::uint64_t>(off_type(to));
    return to;
  }

 private:
  void flush() {
    try {
      if (!problem_) file_.write_at(begin_, waiting_);
    } catch (...) {
      problem_ = std::current_exception();
    }
    begin_ += waiting_.size();
    waiting_.clear();
  }

  static constexpr std::size_t kBlock = 1 << 20;
  AtomicFile& file_;
  std::uint64_t begin_ = 0;  ///< where in the file the waiting bytes belong
  std::string waiting_;
  std::exception_ptr problem_;
};

/// VTK's writer onto a stream of ours.
class StreamWriter : public vtkXMLPolyDataWriter {
 public:
  static StreamWriter* New() {
    auto* writer = new StreamWriter;
    writer->InitializeObjectBase();
    return writer;
  }
  std::ostream* out = nullptr;

 protected:
  int StartFile() override {
    Stream = out;  // in place of the string that it has opened
    GetDataStream()->SetStream(out);
    return Superclass::StartFile();
  }
};

}  // namespace

void write_vtp(AtomicFile& file, vtkPolyData* data, Packing packing) {
  FileBuffer buffer(file);
  std::ostream out(&buffer);
  vtkNew<StreamWriter> writer;
  writer->out = &out;
  writer->WriteToOutputStringOn();  // into a string that stays empty: no file of its own
  writer->SetInputData(data);
  // Inline though 30 % larger: ParaView of Debian 12 with today's libexpat refuses appended data (VTK issue 19258).
  writer->SetDataModeToBinary();
  if (packing == Packing::plain) {
    writer->SetCompressorTypeToNone();
  } else {
    writer->SetCompressorTypeToZLib();
    writer->SetCompressionLevel(1);  // 6 halves the speed and saves 3 % on float fields
  }
  const bool written = writer->Write() != 0 && writer->GetErrorCode() == 0 && out;
  buffer.finish();
  if (!written) throw std::runtime_error("VTK could not write " + file.destination().string());
}

}  // namespace clerestory
