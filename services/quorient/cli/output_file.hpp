#pragma once

#include "program.hpp"

#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

namespace quorient::cli {

/// A file that a verb writes. It is made when the first byte is written, so a failed start leaves nothing behind; and an existing file is
/// overwritten only where the user asked for it.
class OutputFile {
public:
    /// Looks, and touches nothing. Ends the verb where the file exists already and `force` is false, or where it could not be written.
    OutputFile(std::string name, bool force);

    /// What is written at once stays whole if the process is killed: nothing is held back. Makes the file at the first call.
    std::ostream& stream();

    /// The system's reason why stream() could not be written; empty where it could.
    const std::string& failure();

    /// After a failure: cuts the file behind its last whole line. @returns how many lines it holds.
    std::uint64_t keep_whole_lines();

    /// After a failure: cuts the file behind its first bytes.
    void keep_first(std::uint64_t bytes);

    /// Ends the verb unless all that was written is on the disk. What there is of it stays.
    void finish();

    /// As finish(), of a page, picture or YAML file: half of one helps nobody, and is taken away.
    void finish_document();

    /// As finish(), of rows: whole ones stay, and the verb says how many.
    void finish_rows();

    const std::string& name() const { return name_; }

private:
    bool is_complete();

    std::string name_;
    std::ofstream stream_;
    std::string failure_;
};

/// Ends the verb where an output is a file that is read, or another output, under whatever name. Empty names count for nothing.
void refuse_shared_names(const std::vector<std::string>& inputs, std::initializer_list<std::string> outputs);

/// `--force`: an existing file is overwritten.
void add_force(Verb& verb, bool& force);

}  // namespace quorient::cli
