#include "sender.hpp"

#include <algorithm>
#include <memory>

namespace quorient::bus::cyclonedds {

namespace {

/// As its participant announces it; empty where that has left.
std::string name_of(dds_entity_t reader, dds_instance_handle_t participant)
{
    const auto announcements = dds_create_reader(dds_get_participant(reader), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
    if (announcements < 0) return {};
    std::string result;
    void* samples[1] = {nullptr};
    dds_sample_info_t info{};
    if (dds_read_instance(announcements, samples, &info, 1, 1, participant) == 1) {
        char* name = nullptr;
        const auto* announced = static_cast<const dds_builtintopic_participant_t*>(samples[0]);
        if (info.valid_data && dds_qget_entity_name(announced->qos, &name) && name) result = name;
        dds_free(name);
        dds_return_loan(announcements, samples, 1);
    }
    dds_delete(announcements);
    return result;
}

struct Free {
    void operator()(dds_builtintopic_endpoint_t* endpoint) const { dds_builtintopic_free_endpoint(endpoint); }
};

}  // namespace

Sender sender_of(dds_entity_t reader, dds_instance_handle_t writer, bool secured)
{
    const std::unique_ptr<dds_builtintopic_endpoint_t, Free> endpoint{dds_get_matched_publication_data(reader, writer)};
    if (!endpoint) return {};
    GuidPrefix guid{};
    std::copy_n(endpoint->participant_key.v, guid.size(), guid.begin());
    return make_sender(name_of(reader, endpoint->participant_instance_handle), guid, secured);
}

}  // namespace quorient::bus::cyclonedds
