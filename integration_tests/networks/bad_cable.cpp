// Carries Ethernet frames between two TAP devices, late and with flipped bits.
//
// The kernel's own network emulation (tc netem) is a module that many kernels do not have; TAP devices are everywhere. A frame written to
// a TAP device has its checksums verified like one from a wire, so a flipped bit ends as a lost packet, unless no checksum covers it.
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <random>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_frame = 65550;
constexpr std::size_t ethernet_header = 14;  // spared: in front of it there is no packet whose checksum could fail
constexpr int frames_at_a_time = 64;         // before the other direction and what is due get their turn

struct Options {
    std::vector<std::string> devices;
    double delay_ms = 0;
    double corruption = 0;
    unsigned seed = 1;
};

int open_tap(const std::string& name)
{
    const int device = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    ifreq request{};
    request.ifr_flags = IFF_TAP | IFF_NO_PI;
    std::strncpy(request.ifr_name, name.c_str(), IFNAMSIZ - 1);
    if (device >= 0 && ::ioctl(device, TUNSETIFF, &request) == 0) return device;
    std::perror(name.c_str());
    return -1;
}

class BadCable {
public:
    BadCable(const Options& options, int one, int other)
        : ends_{one, other},
          delay_{std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::milli>{options.delay_ms})},
          corrupts_{options.corruption},
          random_{options.seed}
    {
    }

    /// Until the end of the input: `b` makes the cable bad, `g` good.
    void carry()
    {
        std::array<pollfd, 3> polled{{{ends_[0], POLLIN, 0}, {ends_[1], POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
        for (;;) {
            const auto timeout = until_due();
            if (::ppoll(polled.data(), polled.size(), timeout.tv_sec < 0 ? nullptr : &timeout, nullptr) < 0) return;
            if (polled[2].revents != 0 && !obey()) return;
            for (const std::size_t end : {0U, 1U}) {
                if ((polled[end].revents & POLLIN) != 0) take(end);
            }
            deliver();
        }
    }

private:
    struct OnTheWay {
        Clock::time_point due;
        std::size_t to;
        std::vector<char> frame;
    };

    timespec until_due() const
    {
        if (on_the_way_.empty()) return {-1, 0};
        const auto wait = std::max(Clock::duration::zero(), on_the_way_.front().due - Clock::now());
        return {0, static_cast<long>(std::chrono::nanoseconds{wait}.count())};
    }

    bool obey()
    {
        char word = 0;
        if (::read(STDIN_FILENO, &word, 1) != 1) return false;
        bad_ = word == 'b';
        return true;
    }

    void take(std::size_t from)
    {
        for (int count = 0; count < frames_at_a_time; ++count) {
            const auto size = ::read(ends_[from], buffer_.data(), buffer_.size());
            if (size <= static_cast<ssize_t>(ethernet_header)) return;  // nothing more, or the device is down
            std::vector<char> frame(buffer_.begin(), buffer_.begin() + size);
            if (bad_ && corrupts_(random_)) flip_bit(frame);
            on_the_way_.push_back({Clock::now() + (bad_ ? delay_ : Clock::duration::zero()), 1 - from, std::move(frame)});
        }
    }

    void flip_bit(std::vector<char>& frame)
    {
        std::uniform_int_distribution<std::size_t> bit{8 * ethernet_header, 8 * frame.size() - 1};
        const auto which = bit(random_);
        frame[which / 8] = static_cast<char>(frame[which / 8] ^ (1 << which % 8));
    }

    /// A frame that the device does not take is lost, as on a wire.
    void deliver()
    {
        for (; !on_the_way_.empty() && on_the_way_.front().due <= Clock::now(); on_the_way_.pop_front()) {
            const auto& next = on_the_way_.front();
            [[maybe_unused]] const auto written = ::write(ends_[next.to], next.frame.data(), next.frame.size());
        }
    }

    std::array<int, 2> ends_;
    Clock::duration delay_;
    std::bernoulli_distribution corrupts_;
    std::mt19937 random_;
    bool bad_ = false;
    std::deque<OnTheWay> on_the_way_;  // due in this order, but for the frames in flight when the cable turns good
    std::array<char, longest_frame> buffer_{};
};

}  // namespace

int main(int argc, char** argv)
{
    CLI::App program{
        "Carries Ethernet frames between two TAP devices, late and with flipped bits. `b` on the input makes it bad, `g` good."};
    Options options;
    program.add_option("devices", options.devices, "Names of the devices to make")->required()->expected(2);
    program.add_option("--delay-ms", options.delay_ms, "Each way")->check(CLI::Range(0.0, 900.0));
    program.add_option("--corruption", options.corruption, "Probability that a frame has one bit flipped")->check(CLI::Range(0.0, 1.0));
    program.add_option("--seed", options.seed, "Of the chance");
    CLI11_PARSE(program, argc, argv);

    const int one = open_tap(options.devices[0]);
    const int other = open_tap(options.devices[1]);
    if (one < 0 || other < 0) return 1;
    std::puts("ready");
    std::fflush(stdout);
    BadCable{options, one, other}.carry();
    return 0;
}
