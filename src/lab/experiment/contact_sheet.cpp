#include "lab/experiment/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>

#include "lab/experiment/pictures.hpp"
#include "metrics/pixel.hpp"

namespace burnish::lab {
namespace {

constexpr std::size_t kMostRows = 12;
constexpr int kLeastSide = 256;  ///< smaller pictures are enlarged
constexpr int kMostSide = 512;   ///< larger ones reduced
constexpr int kGap = 6;
constexpr int kLine = 22;  ///< height of a line of text
constexpr glm::vec4 kPaper{0.09F, 0.09F, 0.1F, 1.0F};
constexpr glm::vec4 kInk{0.95F, 0.95F, 0.95F, 1.0F};
constexpr glm::vec4 kPaleInk{0.62F, 0.72F, 0.82F, 1.0F};

glm::vec4* pixels(Framebuffer& frame, int y) {
    return reinterpret_cast<glm::vec4*>(frame.row(y));
}

/// Every pixel repeated, or the mean of squares of them.
Framebuffer scaled(const Framebuffer& frame) {
    const int side = std::max(frame.width(), frame.height());
    const int times = std::max(1, kLeastSide / side);
    const int part = (side + kMostSide - 1) / kMostSide;
    Framebuffer result(std::max(1, frame.width() / part) * times,
                       std::max(1, frame.height() / part) * times, PixelFormat::rgba32f);
    for (int y = 0; y < result.height(); ++y) {
        for (int x = 0; x < result.width(); ++x) {
            glm::dvec3 sum(0.0);
            double count = 0.0;
            const int left = x / times * part, top = y / times * part;
            for (int v = top; v < std::min(top + part, frame.height()); ++v)
                for (int u = left; u < std::min(left + part, frame.width()); ++u, ++count)
                    sum += glm::dvec3(metrics::pixel(frame, u, v));
            pixels(result, y)[x] = glm::vec4(glm::vec3(sum / count), 1.0F);
        }
    }
    return result;
}

std::string labels_of(const Results& results, std::size_t cell) {
    std::string text;
    const std::vector<ExperimentAxis>& axes = results.experiment.axes;
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
        text += (axis == 0 ? "" : ", ") + axes[axis].values[results.cells[cell].values[axis]].label;
    return text;
}

/// A cell as it is shown.
struct Row {
    std::string labels, numbers;
    std::vector<std::string> reasons;   ///< why a cell was refused, a line each
    std::vector<Framebuffer> pictures;  ///< none of a cell that was refused

    [[nodiscard]] int height() const {
        return kLine + (pictures.empty() ? kLine * static_cast<int>(reasons.size())
                                         : pictures.front().height() + kGap);
    }
    [[nodiscard]] int column() const { return pictures.empty() ? 0 : pictures.front().width(); }
};

/// A refusal names everything that is missing, with semicolons between.
std::vector<std::string> reasons_of(std::string_view refusal) {
    constexpr std::string_view kBetween = "; ";
    std::vector<std::string> reasons;
    while (!refusal.empty()) {
        const std::size_t end = std::min(refusal.find(kBetween), refusal.size());
        reasons.emplace_back(refusal.substr(0, end));
        refusal.remove_prefix(std::min(end + kBetween.size(), refusal.size()));
    }
    return reasons;
}

Row row_of(const Results& results, std::size_t cell, const Store& store) {
    Row row;
    row.labels = labels_of(results, cell);
    row.reasons = reasons_of(results.found[cell]->refusal);
    if (!row.reasons.empty()) return row;
    for (const auto& [metric, name] : {std::pair{"rmse", "RMSE"}, std::pair{"flip", "FLIP"}})
        if (const std::optional<double> value = results.value(cell, metric))
            row.numbers +=
                fmt::format("{}{} {:.3g}", row.numbers.empty() ? "" : "    ", name, *value);
    const PictureFiles files{store.images(), results.cells[cell].name};
    for (const std::filesystem::path& file :
         {files.exr("test"), files.exr("reference"), files.png("error"), files.png("flip")})
        row.pictures.push_back(scaled(load_frame(file)));
    return row;
}

/// Paper, text and pictures.
class Page {
  public:
    Page(int width, int height, std::string& problem)
        : m_frame(width, height, PixelFormat::rgba32f), m_problem(problem) {
        for (int y = 0; y < height; ++y) std::fill_n(pixels(m_frame, y), width, kPaper);
    }
    void write(int x, int y, const std::string& text, const glm::vec4& color) {
        constexpr int kLetters = 15;
        if (!m_problem.empty()) return;
        try {
            draw_text(m_frame, x, y + kLine - 7, text, kLetters, color);
        } catch (const Error& error) {
            m_problem = fmt::format("sheets without captions: {}", error.what());
        }
    }
    void place(int x, int y, Framebuffer& picture) {
        for (int v = 0; v < picture.height(); ++v)
            std::copy_n(pixels(picture, v), picture.width(), pixels(m_frame, y + v) + x);
    }
    [[nodiscard]] const Framebuffer& frame() const { return m_frame; }

  private:
    Framebuffer m_frame;
    std::string& m_problem;
};

Page draw_page(const ExperimentSheet& sheet, std::vector<Row>& rows, std::string& problem) {
    int height = 2 * kLine, column = kLeastSide;
    for (const Row& row : rows) {
        height += row.height();
        column = std::max(column, row.column());
    }
    const auto x = [&](int i) { return kGap + i * (column + kGap); };
    Page page(x(4), height, problem);
    page.write(kGap, 0, sheet.title, kInk);
    const std::array<std::string, 4> heads{
        "test", "reference", fmt::format("test - reference, times {}", sheet.gain), "FLIP"};
    for (int i = 0; i < 4; ++i)
        page.write(x(i), kLine, heads.at(static_cast<std::size_t>(i)), kPaleInk);
    int y = 2 * kLine;
    for (Row& row : rows) {
        page.write(kGap, y, row.labels, kInk);
        page.write(x(2), y, row.numbers, kPaleInk);
        for (std::size_t i = 0; i < row.reasons.size(); ++i)
            page.write(kGap, y + kLine * (static_cast<int>(i) + 1), row.reasons[i], kPaleInk);
        for (std::size_t i = 0; i < row.pictures.size(); ++i)
            page.place(x(static_cast<int>(i)), y + kLine, row.pictures[i]);
        y += row.height();
    }
    return page;
}

/// The cells that a sheet shows and whose results are there.
std::vector<std::size_t> cells_of(const Results& results, const ExperimentSheet& sheet,
                                  const Store& store) {
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
        if (!results.found[i] || !matches(results.experiment, results.cells[i], sheet.where))
            continue;
        std::error_code ignored;
        const PictureFiles files{store.images(), results.cells[i].name};
        if (!results.found[i]->refusal.empty() ||
            std::filesystem::is_regular_file(files.exr("test"), ignored))
            cells.push_back(i);
    }
    return cells;
}

}  // namespace

DrawnSheets draw_sheets(const Results& results, const Store& store,
                        const std::filesystem::path& directory) {
    DrawnSheets drawn;
    std::filesystem::create_directories(directory);
    for (const ExperimentSheet& sheet : results.experiment.sheets) {
        std::vector<SheetPage>& pages = drawn.sheets.emplace_back();
        const std::vector<std::size_t> cells = cells_of(results, sheet, store);
        for (std::size_t first = 0; first < cells.size(); first += kMostRows) {
            std::vector<Row> rows;
            SheetPage page;
            for (std::size_t i = first; i < std::min(first + kMostRows, cells.size()); ++i) {
                rows.push_back(row_of(results, cells[i], store));
                page.rows += (page.rows.empty() ? "" : "; ") + rows.back().labels;
            }
            std::string name = fmt::format("sheet-{}", drawn.sheets.size());
            if (!pages.empty()) name += fmt::format("-{}", pages.size() + 1);
            page.png = directory / (name + ".png");
            const Page picture = draw_page(sheet, rows, drawn.problem);
            save_image(shown(picture.frame()), page.png);
            save_image(picture.frame(), directory / (name + ".exr"));
            pages.push_back(std::move(page));
        }
    }
    return drawn;
}

}  // namespace burnish::lab
