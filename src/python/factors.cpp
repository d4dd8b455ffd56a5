// Form factors: of meshes, of other matrices, between surfaces, from points.
#include <pybind11/stl.h>

#include <limits>
#include <utility>
#include <variant>

#include "arrays.h"
#include "handles.h"
#include "long_call.h"
#include "options.h"
#include "reports.h"

namespace radiosity::python {
namespace {

/// Given options that the method does not use, and that are not what they are by default.
std::vector<std::string> unusedOptions(const py::dict& given, const std::string& method) {
  auto options = optionsFrom<FormFactorOptions>(given);
  options.method = named(kMethodNames, method).value_or(options.method);
  const py::list usual = described(FormFactorOptions());
  std::vector<std::string> unused;
  for (std::size_t k = 0; const py::handle& option : described(options)) {
    const bool changed = !option["value"].equal(usual[k++]["value"]);
    if (changed && !option["used"].cast<bool>()) unused.push_back(py::str(option["name"]));
  }
  return unused;
}

std::shared_ptr<FactorsHandle> formFactors(std::shared_ptr<MeshHandle> mesh, const py::dict& given,
                                           const py::object& report) {
  auto options = optionsFrom<FormFactorOptions>(given);
  // Its arrays list them: rows that are cut have to be asked for.
  options.needs_pairs = options.method == FormFactorMethod::automatic;
  auto handle = std::make_shared<FactorsHandle>();
  handle->mesh = std::move(mesh);
  handle->key = [options, mesh = handle->mesh] { return keyOfFactors(options, mesh->result.mesh); };
  runLong(report, [&](Progress& progress) {
    const PatchMesh& patches = handle->mesh->result.mesh;
    options.exact_rows = emittingPatches(patches, handle->mesh->materials);
    // The plan shares the mesh that the handle keeps.
    const std::shared_ptr<const PatchMesh> shared(handle->mesh, &patches);
    const FormFactorPlan plan = planFormFactors(shared, options, progress);
    handle->factors = computeFormFactors(plan, progress);
    handle->factors.report.estimated_bytes = plan.bytes;
  });
  return handle;
}

/// Compressed rows in scipy's layout.
template <class Value, class Place>
struct CompressedRows {
  std::vector<Value> data;
  std::vector<Place> indices;
  std::vector<Place> starts;

  CompressedRows() = default;
  CompressedRows(const ExchangeMatrix& matrix, std::size_t entries, Progress& progress)
      : data(entries), indices(entries), starts(matrix.size() + 1, 0) {
    std::size_t at = 0;
    progress.begin("rows", matrix.size(), "rows");
    matrix.forPanels([&](const RowPanel& panel) {
      for (std::size_t i = panel.first(); i < panel.last(); ++i) {
        progress.check();
        panel.forRow(i, [&](Index column, double value) {
          indices[at] = Place(column);
          data[at++] = Value(value);
        });
        starts[i + 1] = Place(at);
        progress.advance();
      }
    });
    progress.end();
  }
};

template <class Value>
using EitherRows =
    std::variant<CompressedRows<Value, std::int32_t>, CompressedRows<Value, std::int64_t>>;

/// Uses indices of 32 bits if they suffice.
template <class Value>
py::tuple rowsOf(const ExchangeMatrix& matrix, const py::object& report) {
  EitherRows<Value> rows;
  runLong(report, [&](Progress& progress) {
    const std::size_t entries = matrix.nonZeros();
    progress.check();
    if (entries <= std::size_t(std::numeric_limits<std::int32_t>::max())) {
      rows.template emplace<0>(matrix, entries, progress);
    } else {
      rows.template emplace<1>(matrix, entries, progress);
    }
  });
  return std::visit(
      [](auto& r) {
        return py::make_tuple(taken(std::move(r.data)), taken(std::move(r.indices)),
                              taken(std::move(r.starts)));
      },
      rows);
}

py::tuple csrArrays(const FactorsHandle& handle, const py::object& report) {
  const ExchangeMatrix& matrix = pairsOf(*handle.factors.matrix);
  return matrix.precision() == Precision::single_precision ? rowsOf<float>(matrix, report)
                                                           : rowsOf<double>(matrix, report);
}

/// F x for values (rows, columns).
py::array product(const FactorsHandle& handle, const Array<double>& values) {
  const ExchangeOperator& matrix = *handle.factors.matrix;
  py::array_t<double> result({values.shape(0), values.shape(1)});
  const std::span<double> y(result.mutable_data(), std::size_t(result.size()));
  const int columns = int(values.shape(1));
  const std::span<const double> x = spanOf(values);
  const py::gil_scoped_release released;
  matrix.product(x, columns, y);
  return result;
}

std::shared_ptr<FactorsHandle> fromCsr(const Array<double>& data, const Array<Index>& indices,
                                       const Array<std::int64_t>& starts, const Array<double>& area,
                                       const Array<double>& sky, const Array<double>& backs,
                                       const std::vector<std::string>& names, bool single) {
  auto handle = std::make_shared<FactorsHandle>();
  runLong(py::none(), [&](Progress& progress) {
    const auto matrix = std::make_shared<RowMatrix>(
        vectorOf(area), single ? Precision::single_precision : Precision::double_precision);
    for (std::size_t i = 0; i < matrix->size(); ++i) {
      progress.check();
      const auto first = std::size_t(starts.data()[i]);
      const auto count = std::size_t(starts.data()[i + 1]) - first;
      matrix->setRow(i, spanOf(indices).subspan(first, count), spanOf(data).subspan(first, count));
    }
    handle->factors = factorsOfMatrix(matrix, vectorOf(sky), vectorOf(backs));
  });
  handle->names = names;
  return handle;
}

std::shared_ptr<FactorsHandle> readMatrix(const std::string& path, const py::object& report) {
  auto handle = std::make_shared<FactorsHandle>();
  runLong(report, [&](Progress& progress) {
    const MatrixFile file = readMatrixFile(path, progress);
    handle->factors = factorsOfFile(file);
    handle->names = file.factors.names;
  });
  return handle;
}

py::dict table(const py::object& self, const std::vector<std::string>& groups,
               const py::object& report) {
  const auto& handle = self.cast<const FactorsHandle&>();
  const PatchMesh& mesh = meshOf(handle, "a table by surface names").result.mesh;
  NamedFactors named;
  std::vector<double> factors;
  std::vector<double> errors;
  std::string markdown;
  runLong(report, [&](Progress& progress) {
    named =
        factorsBetween(mesh, handle.factors, groupSurfaces(mesh.surface_names, groups), progress);
    for (std::size_t a = 0; a < named.size(); ++a) {
      for (std::size_t b = 0; b < named.size(); ++b) {
        factors.push_back(named.matrix->at(a, b));
        errors.push_back(named.entryError(a, b));
      }
    }
    markdown = factorsMarkdown(named, TableLayout::wide);
  });
  py::dict dict;
  dict["names"] = named.names;
  dict["area"] = py::array_t<double>(py::ssize_t(named.size()), named.matrix->area().data());
  dict["factors"] = taken(std::move(factors));
  dict["entry_error"] = taken(std::move(errors));
  dict["sky"] = taken(std::move(named.sky));
  dict["backs"] = taken(std::move(named.backs));
  dict["markdown"] = printable(markdown);
  return dict;
}

py::array fromPoints(const MeshHandle& mesh, const Array<double>& points,
                     const Array<double>& normals, const py::object& report) {
  const auto rows = std::size_t(points.size()) / 3;
  py::array_t<double> factors({py::ssize_t(rows), py::ssize_t(mesh.result.mesh.size())});
  const std::span<double> values(factors.mutable_data(), std::size_t(factors.size()));
  runLong(report, [&](Progress& progress) {
    pointFormFactors(mesh.result.mesh, vectorsOf(points), vectorsOf(normals), values, progress);
  });
  return factors;
}

}  // namespace

const MeshHandle& meshOf(const FactorsHandle& factors, const char* asks) {
  if (factors.mesh) return *factors.mesh;
  throw InputError(fmt::format(
      "{}: these form factors are a matrix without a mesh; use those of form_factors(mesh)", asks));
}

void bindFactors(py::module_& module) {
  using H = FactorsHandle;
  py::class_<H, std::shared_ptr<H>> type(module, "FormFactors");
  const auto array = [&](const char* name, auto field) {
    type.def_property_readonly(name, [field](const py::object& self) {
      return view(self.cast<const H&>().factors.*field, self);
    });
  };
  array("fronts", &FormFactors::fronts);
  array("sky", &FormFactors::sky);
  array("backs", &FormFactors::backs);
  array("error", &FormFactors::error);
  type.def_property_readonly("area", [](const py::object& self) {
    const auto area = self.cast<const H&>().factors.matrix->area();
    return view(area.data(), {py::ssize_t(area.size())}, self);
  });
  type.def_property_readonly(
      "mesh", [](const H& h) { return std::const_pointer_cast<MeshHandle>(h.mesh); });
  type.def_readonly("names", &H::names);
  type.def_property_readonly(
      "method", [](const H& h) { return nameOf(kFactorsFromNames, h.factors.method); });
  type.def_property_readonly("symmetric",
                             [](const H& h) { return h.factors.matrix->isSymmetric(); });
  type.def_property_readonly("report", [](const H& h) { return dictOf(h.factors.report); });
  module.def("form_factors", &formFactors);
  module.def("unused_options", &unusedOptions);
  module.def("csr_arrays", &csrArrays);
  module.def("product", &product);
  module.def("from_csr", &fromCsr);
  module.def("read_matrix", &readMatrix);
  module.def("table", &table);
  module.def("from_points", &fromPoints);
}

}  // namespace radiosity::python
