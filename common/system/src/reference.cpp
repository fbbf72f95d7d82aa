#include "quorient/configuration/reference.hpp"

#include "quorient/system/system.hpp"
#include "sections/file.hpp"

#include <string_view>

namespace quorient::system {

namespace {

constexpr std::string_view introduction =
    "<!-- Generated: quorient check --reference > docs/system-file.md -->\n"
    "\n"
    "# The system file\n"
    "\n"
    "One YAML file describes a system: its unit, the source of frames, all lanes and voters, and how their processes meet. Every process\n"
    "receives the file and its own name in it. Examples are in `deploy/configurations`.\n"
    "\n"
    "`quorient check FILE` judges a file as all processes would, starts nothing, and prints the configuration with every value that "
    "holds.\n"
    "`--set key=value` sets a value in place of the file's; items of lists go by name or number: `lanes.a.detector.sigma`, "
    "`lanes[0].detector.sigma`.\n"
    "`quorient check --key voting.patience` explains one key or one section on the terminal.\n"
    "\n"
    "The column *left out* says what holds where a key is absent. Units stand in brackets; times are in seconds unless a key's name says "
    "otherwise.\n";

}  // namespace

configuration::Chapter reference()
{
    return file_table().chapter();
}

std::string reference_page()
{
    return std::string{introduction} + configuration::reference(reference(), "The whole file");
}

}  // namespace quorient::system
