#include "guarded_transport.hpp"

#include "foreign_acknacks.hpp"
#include "handshake.hpp"
#include "rtps_guard.hpp"

#include <mutex>
#include <set>

namespace quorient::bus::fastdds {

using wire::Locator_t;
using wire::LocatorsIterator;
using wire::octet;

namespace {

struct GuardedDescriptor final : rtps::ChainingTransportDescriptor {
    GuardedDescriptor(std::shared_ptr<rtps::TransportDescriptorInterface> below, Listening is_listening)
        : rtps::ChainingTransportDescriptor(std::move(below)), listening(std::move(is_listening))
    {
    }
    rtps::TransportInterface* create_transport() const override;

    Listening listening;
};

/// Called with each address before the first datagram is sent to it.
template <class Announce>
class Announcing final : public LocatorsIterator {
public:
    Announcing(LocatorsIterator& locators, const Announce& announce) : locators_(locators), announce_(announce) {}

    LocatorsIterator& operator++() override
    {
        ++locators_;
        return *this;
    }
    bool operator==(const LocatorsIterator& other) const override { return locators_ == static_cast<const Announcing&>(other).locators_; }
    bool operator!=(const LocatorsIterator& other) const override { return locators_ != static_cast<const Announcing&>(other).locators_; }
    const Locator_t& operator*() const override
    {
        const Locator_t& locator = *locators_;
        announce_(locator);
        return locator;
    }

private:
    LocatorsIterator& locators_;
    const Announce& announce_;
};

class GuardedTransport final : public rtps::ChainingTransport {
public:
    explicit GuardedTransport(const GuardedDescriptor& descriptor) : rtps::ChainingTransport(descriptor), descriptor_(descriptor) {}

    rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

    bool send(SenderResource* below, Outgoing datagram, std::uint32_t size, LocatorsIterator* begin, LocatorsIterator* end,
              const std::chrono::steady_clock::time_point& timeout) override
    {
        if (!descriptor_.listening->load(std::memory_order_relaxed)) return true;
        if (const auto begins = beginning(datagram, size); is_handshake(begins.data(), begins.size())) pause_.sent();
        const auto announce = [this](const Locator_t& locator) { know(locator); };
        Announcing first{*begin, announce};
        Announcing last{*end, announce};
        LocatorsIterator* from = &first;
        LocatorsIterator* to = &last;
        return below->send(datagram, size, from, to, timeout);
    }

    void receive(rtps::TransportReceiverInterface* above, const octet* buffer, std::uint32_t size, const Locator_t& local,
                 const Locator_t& remote) override
    {
        if (!is_sound_rtps(buffer, size)) return;
        const auto understood = with_understood_acknacks(buffer, size);
        std::unique_lock one_at_a_time{discovery_, std::defer_lock};
        if (is_discovery(local)) {
            if (is_handshake(buffer, size)) pause_.lock_after(one_at_a_time);
            else one_at_a_time.lock();
        }
        above->OnDataReceived(understood ? understood->data() : buffer, size, local, remote);
    }

private:
    /// Fast DDS 2.9.1 as packaged (statistics and assertions on) counts per address. It aborts on the first datagram to an address without
    /// an open channel: an endpoint that announces another address than its node did, by damage or by design [eProsima/Fast-DDS issue
    /// 3285]. Opening a channel registers the address; the channel itself, a socket, is not needed. Sends are serialised above.
    void know(const Locator_t& locator)
    {
        if (!known_.insert(locator).second) return;
        rtps::SendResourceList not_needed;
        low_level_transport_->OpenOutputChannel(not_needed, locator);
    }

    /// Ports for discovery are even, multicast and unicast; those for samples are odd [RTPS 2.3, 9.6.1.1].
    static bool is_discovery(const Locator_t& local) { return local.port % 2 == 0; }

    GuardedDescriptor descriptor_;
    std::mutex discovery_;
    HandshakePause pause_;
    std::set<Locator_t> known_;
};

rtps::TransportInterface* GuardedDescriptor::create_transport() const
{
    return new GuardedTransport(*this);  // Fast DDS takes it over
}

}  // namespace

std::shared_ptr<rtps::TransportDescriptorInterface> guarded(std::shared_ptr<rtps::TransportDescriptorInterface> transport,
                                                            Listening listening)
{
    return std::make_shared<GuardedDescriptor>(std::move(transport), std::move(listening));
}

}  // namespace quorient::bus::fastdds
