#include "instrument_log_test.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <sstream>

namespace quorient::recording {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double degree = 3.14159265358979323846 / 180;

/// Rows of a gyro of 100 Hz: times in s from 1, rates 1, 2, 3 deg/s times the number of the row.
std::string rows(std::size_t count, const std::string& header, const std::string& mark = ",", const std::string& end = "\n")
{
    std::ostringstream text;
    text << header << end;
    for (std::size_t i = 0; i < count; ++i) {
        text << 1 + 0.01 * static_cast<double>(i);
        for (int k = 1; k <= 3; ++k) text << mark << static_cast<double>(i) * k + 0.5;
        text << end;
    }
    return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
    return text;
}

void expect_the_rows(const Samples& log, std::size_t count, const std::string& name)
{
    ASSERT_THAT(log.names(), ElementsAre(name));
    EXPECT_TRUE(log.problems.empty()) << log.problems[0];
    ASSERT_EQ(log.samples.size(), count);
    EXPECT_EQ(log.samples[5].time_ns, 1'050'000'000);
    EXPECT_NEAR(log.samples[5].rate_rad_s[2], 15.5 * degree, 1e-12);
}

TEST(CsvLog, reads_every_way_of_writing_a_table)
{
    const std::string plain = rows(20, "time_s,gx [deg/s],gy [deg/s],gz [deg/s]");
    expect_the_rows(samples_of(plain), 20, "log");
    expect_the_rows(samples_of("\xEF\xBB\xBF" + plain), 20, "log");
    expect_the_rows(samples_of(replaced(plain, "\n", "\r\n")), 20, "log");
    expect_the_rows(samples_of(replaced(plain, ",", "\t")), 20, "log");
    expect_the_rows(samples_of(replaced(plain, ",", " ; ")), 20, "log");
    expect_the_rows(samples_of(rows(20, "time_s gx_dps gy_dps gz_dps", "   ")), 20, "log");
    expect_the_rows(samples_of(replaced(replaced(plain, ",", ";"), ".", ",")), 20, "log");
    expect_the_rows(samples_of("\"time_s\",\"gx [deg/s]\",\"gy [deg/s]\",\"gz [deg/s]\"\n" + plain.substr(plain.find('\n') + 1)), 20, "log");
    expect_the_rows(samples_of("device: X\nserial,12\n# a remark\n" + plain + "\n\n"), 20, "log");
    expect_the_rows(samples_of("# " + plain), 20, "log");
}

TEST(CsvLog, reads_cells_between_quotes_with_the_delimiter_inside)
{
    const Samples log = samples_of(std::string("time_s,note,gx_dps,gy_dps,gz_dps\n1.00,\"a, b\",\"1\",2,3\n1.01,\"c, d, e\",\"1\",2,3\n"));
    ASSERT_EQ(log.samples.size(), 2U);
    EXPECT_NEAR(log.samples[1].rate_rad_s[2], 3 * degree, 1e-12);
}

TEST(CsvLog, refuses_decimal_commas_between_commas)
{
    EXPECT_THAT(refusal_of("time_s,gx_dps,gy_dps,gz_dps\n1,00,1,5,2,5,3,5\n1,01,1,5,2,5,3,5\n"), HasSubstr("parted by ;"));
}

struct TimeCase {
    const char* header;
    std::vector<const char*> cells;
    std::int64_t first_ns;
    std::int64_t step_ns;
    bool judged;  ///< its unit is named neither by the header nor by the cells
};

TEST(CsvLog, reads_times_in_every_unit_named_or_not_and_says_what_it_judged)
{
    const std::vector<TimeCase> cases{
        {"time_s", {"12.5", "12.51", "12.52"}, 12'500'000'000, 10'000'000, false},
        {"t [ms]", {"12500", "12510", "12520"}, 12'500'000'000, 10'000'000, false},
        {"TimeUS", {"12500000", "12510000", "12520000"}, 12'500'000'000, 10'000'000, false},
        {"t", {"1713722594469036102", "1713722594478036102", "1713722594487036102"}, 1713722594469036102, 9'000'000, true},
        {"ts", {"118892", "118902", "118912"}, 118'892'000'000, 10'000'000, true},
        {"timestamp", {"4000", "8000", "12000"}, 4'000'000, 4'000'000, true},
        {"t", {"-0.331", "-0.321", "-0.311"}, -331'000'000, 10'000'000, true},
        {"time", {"1.5e1", "1.501e1", "1.502e1"}, 15'000'000'000, 10'000'000, true},
        {"time",
         {"2024-05-01T12:00:00.250Z", "2024-05-01T12:00:00.260Z", "2024-05-01T12:00:00.270Z"},
         1714564800250000000,
         10'000'000,
         false},
        {"time",
         {"2024-05-01 14:00:00.25+02:00", "2024-05-01 14:00:00.26+02:00", "2024-05-01 14:00:00.27+02:00"},
         1714564800250000000,
         10'000'000,
         false}};
    for (const TimeCase& given : cases) {
        SCOPED_TRACE(std::string(given.header) + " " + given.cells[0]);
        std::string text = std::string(given.header) + ",gx_dps,gy_dps,gz_dps\n";
        for (const char* const cell : given.cells) text += std::string(cell) + ",1,2,3\n";
        const Samples log = samples_of(text);
        ASSERT_EQ(log.samples.size(), 3U);
        EXPECT_EQ(log.samples[0].time_ns, given.first_ns);
        EXPECT_EQ(log.samples[2].time_ns - log.samples[1].time_ns, given.step_ns);
        const auto said = [](const std::string& remark) { return remark.starts_with("time read as"); };
        EXPECT_EQ(std::any_of(log.remarks.begin(), log.remarks.end(), said), given.judged);
    }
    EXPECT_THAT(refusal_of("t,gx_dps,gy_dps,gz_dps\n1000,1,2,3\n1900,1,2,3\n"), "it was opened");
    EXPECT_THAT(refusal_of("t,gx_dps,gy_dps,gz_dps\n10,1,2,3\n20,1,2,3\n"), "it was opened");
    EXPECT_THAT(refusal_of("t,gx_dps,gy_dps,gz_dps\n1e13,1,2,3\n2e13,1,2,3\n"), HasSubstr("--time-unit"));
}

TEST(CsvLog, adds_nanoseconds_to_seconds_where_they_stand_apart)
{
    const Samples log = samples_of(std::string("header.stamp.secs,header.stamp.nsecs,wx,wy,wz\n5,990000000,80,2,3\n6,0,1,2,3\n6,10000000,1,2,3\n"));
    ASSERT_EQ(log.samples.size(), 3U);
    EXPECT_EQ(log.samples[0].time_ns, 5'990'000'000);
    EXPECT_EQ(log.samples[2].time_ns, 6'010'000'000);
}

TEST(CsvLog, reads_wide_and_long_tables_alike)
{
    const Samples wide = samples_of(std::string("t_s,g0x_dps,g0y_dps,g0z_dps,a0x,a0y,a0z,g1x_dps,g1y_dps,g1z_dps\n"
                                                "1.00,1,2,3,0,0,1.0,4,5,6\n1.01,1,2,3,0,0,1.01,4,5,6\n"));
    EXPECT_THAT(wide.names(), ElementsAre("g0", "g1"));
    ASSERT_EQ(wide.of("g1").size(), 2U);
    EXPECT_NEAR(wide.of("g1")[1].rate_rad_s[0], 4 * degree, 1e-12);
    EXPECT_NEAR(wide.of("g0")[0].acceleration_m_s2[2], 9.80665, 1e-9);
    EXPECT_TRUE(std::isnan(wide.of("g1")[0].acceleration_m_s2[2]));

    const Samples tall = samples_of(std::string(",ts,id,Gx dps,Gy dps,Gz dps\n0,118892,IMU0,1,2,3\n1,118892,IMU1,4,5,6\n2,118902,IMU0,1,2,3\n"
                                                "3,118912,IMU0,1,2,3\n4,118912,IMU1,4,5,6\n"));
    EXPECT_THAT(tall.names(), ElementsAre("IMU0", "IMU1"));
    EXPECT_EQ(tall.of("IMU0").size(), 3U);
    ASSERT_EQ(tall.of("IMU1").size(), 2U);
    EXPECT_EQ(tall.of("IMU1")[1].time_ns, 118'912'000'000);

    const Samples numbered = samples_of(std::string("t_ms,I,gx_dps,gy_dps,gz_dps\n10,0,1,2,3\n10,1,1,2,3\n20,0,1,2,3\n"));
    EXPECT_THAT(numbered.names(), ElementsAre("I0", "I1"));
}

TEST(CsvLog, leaves_out_what_a_row_does_not_hold)
{
    const Samples log =
        samples_of(std::string("t_s,g0x_dps,g0y_dps,g0z_dps,g1x_dps,g1y_dps,g1z_dps\n1.00,1,2,3,,,\n1.01,1,nan,3,4,5,6\n1.02,,,,4,5,6\n"));
    EXPECT_EQ(log.of("g0").size(), 2U);
    EXPECT_EQ(log.of("g1").size(), 2U);
    EXPECT_TRUE(std::isnan(log.of("g0")[1].rate_rad_s[1]));
    EXPECT_NEAR(log.of("g0")[1].rate_rad_s[2], 3 * degree, 1e-12);
}

TEST(CsvLog, names_the_line_of_what_it_refuses)
{
    const Samples log = samples_of(std::string("t_s,gx_dps,gy_dps,gz_dps\n1.00,1,2,3\n1.01,1,zwei,3\n1.02,1\nnow,1,2,3\n1.03,1,2,3\n"));
    EXPECT_EQ(log.samples.size(), 2U);
    EXPECT_THAT(log.problems, ElementsAre(AllOf(HasSubstr("log.csv:3:"), HasSubstr("'zwei'")), HasSubstr("log.csv:4:"),
                                          AllOf(HasSubstr("log.csv:5:"), HasSubstr("'now'"))));
    EXPECT_EQ(log.statistics.malformed, 3U);
}

TEST(CsvLog, divides_increments_by_their_interval)
{
    const Samples own = samples_of(std::string("time,increment_0,increment_1,increment_2,increment_3,increment_4,increment_5\n"
                                               "0.01,0.1,0.2,0.3,0.4,0.5,0.6\n0.02,0.1,0.2,0.3,0.4,0.5,0.6\n0.04,0.1,0.2,0.3,0.4,0.5,0.6\n"));
    EXPECT_THAT(own.names(), ElementsAre("axes 0-2", "axes 3-5"));
    ASSERT_EQ(own.of("axes 3-5").size(), 2U);
    EXPECT_NEAR(own.of("axes 3-5")[0].rate_rad_s[0], 40, 1e-9);
    EXPECT_NEAR(own.of("axes 3-5")[1].covered_s, 0.02, 1e-12);

    const Samples px4 = samples_of(std::string("timestamp,delta_angle[0],delta_angle[1],delta_angle[2],delta_angle_dt\n"
                                               "1000000,0.01,0,0,5000\n1500000,0.01,0,0,5000\n1600000,0.01,0,0,5000\n"),
                                   {RateUnit::rad_s, std::nullopt, TimeUnit::us});
    ASSERT_EQ(px4.samples.size(), 3U);
    EXPECT_NEAR(px4.samples[1].rate_rad_s[0], 2.0, 1e-9) << "its own 5 ms, not the 500 ms since the row before";
    EXPECT_THAT(refusal_of("time,increment_0,increment_1,increment_2,increment_3\n1,1,1,1,1\n2,1,1,1,1\n"), HasSubstr("4 axes are no triads"));
}

/// A table without units whose rates are multiples of this step: a rest with noise, then a turn.
std::string unnamed_rates(double step, double largest)
{
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0.0, 3.0);
    std::ostringstream text;
    text.precision(10);
    text << "t_s,gx,gy,gz\n";
    for (int i = 0; i < 3000; ++i) {
        text << 0.01 * i;
        for (int k = 0; k < 3; ++k) text << ',' << std::round(noise(random) + (i > 2000 ? largest / step * std::sin(0.01 * i) : 0)) * step;
        text << '\n';
    }
    return text.str();
}

TEST(CsvLog, tells_the_unit_by_the_sensors_step)
{
    const Samples radians = samples_of(unnamed_rates(degree / 16.4, 1.0));
    EXPECT_THAT(radians.remarks, Contains(AllOf(HasSubstr("read as rad/s"), HasSubstr("0.0610 deg/s"))));
    const Samples degrees = samples_of(unnamed_rates(0.07, 50.0));
    EXPECT_THAT(degrees.remarks, Contains(AllOf(HasSubstr("read as deg/s"), HasSubstr("0.07"))));
    EXPECT_NEAR(degrees.samples[2100].rate_rad_s[0] / degree, 50.0 * std::sin(21.0), 1.0);
}

TEST(CsvLog, tells_the_unit_by_rates_that_no_gyro_reads)
{
    const Samples log = samples_of(unnamed_rates(0.0333, 300.0));
    EXPECT_THAT(log.remarks, Contains(AllOf(HasSubstr("read as deg/s"), HasSubstr("no gyro"))));
}

TEST(CsvLog, refuses_what_it_cannot_tell_and_says_what_to_do)
{
    const std::string text = unnamed_rates(0.0333, 30.0);
    EXPECT_THAT(refusal_of(text), AllOf(HasSubstr("log.csv:1:"), HasSubstr("--unit deg/s")));
    EXPECT_NEAR(samples_of(text, {RateUnit::deg_s, {}, {}}).samples[2100].rate_rad_s[0] / degree, 30.0 * std::sin(21.0), 1.0);
    EXPECT_THAT(refusal_of(unnamed_rates(0.0333, 9000.0)), HasSubstr("more than any gyro"));
    EXPECT_THAT(refusal_of(unnamed_rates(1, 5000.0)), HasSubstr("--lsb-per-deg-s"));
    const Samples counts = samples_of(unnamed_rates(1, 5000.0), {{}, 16.4, {}});
    EXPECT_NEAR(counts.samples[2100].rate_rad_s[0] / degree, 5000.0 * std::sin(21.0) / 16.4, 1.0);
    EXPECT_THAT(refusal_of("t_s,gx,gy,gz\n0.01,1,2,3\n0.02,1,2,3\n", {RateUnit::deg_s, 16.4, {}}), HasSubstr("contradict"));
}

TEST(CsvLog, tells_the_unit_by_gravity_that_turns_with_the_body)
{
    const auto turning = [](double unit) {
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0.0, 0.02);
        std::ostringstream text;
        text.precision(9);
        text << "t_s,gx,gy,gz,ax,ay,az\n";
        for (int i = 0; i < 6000; ++i) {
            const double angle = std::sin(0.005 * i);
            const double rate = 0.5 * std::cos(0.005 * i);  // d angle / dt at 100 Hz
            text << 0.01 * i << ',' << (rate + noise(random)) / unit << ',' << noise(random) / unit << ',' << noise(random) / unit << ','
                 << noise(random) << ',' << std::sin(angle) + noise(random) << ',' << std::cos(angle) + noise(random) << '\n';
        }
        return text.str();
    };
    EXPECT_THAT(samples_of(turning(1.0)).remarks, Contains(AllOf(HasSubstr("read as rad/s"), HasSubstr("gravity"))));
    EXPECT_THAT(samples_of(turning(degree)).remarks, Contains(AllOf(HasSubstr("read as deg/s"), HasSubstr("gravity"))));
    const std::string columns = "gx,gy,gz,";
    const auto stated = [&](const std::string& text, const std::string& unit) {
        return samples_of(replaced(text, columns, "gx [" + unit + "],gy [" + unit + "],gz [" + unit + "],")).remarks;
    };
    EXPECT_THAT(stated(turning(1.0), "deg/s"), Contains(HasSubstr("unit may be wrong")));
    EXPECT_THAT(stated(turning(1.0), "rad/s"), testing::Not(Contains(HasSubstr("unit may be wrong"))));
}

TEST(CsvLog, reads_the_units_of_a_header_however_they_are_spelled)
{
    const std::string body = rows(20, "");
    for (const std::string unit : {"[\xC2\xB0/s]", "(\xC2\xBA/s)", "[\xB0/s]", "(degrees/s)", "[deg s^-1]", "(deg per s)", "[deg/sec]", "(dps)"}) {
        SCOPED_TRACE(unit);
        expect_the_rows(samples_of("Time (s),gx " + unit + ",gy " + unit + ",gz " + unit + body), 20, "log");
        expect_the_rows(samples_of("Zeit [s],gx " + unit + ",gy,gz" + body), 20, "log");
    }
    expect_the_rows(samples_of("time,gx,gy,gz\ns,deg/s,deg/s,deg/s" + body), 20, "log");
}

TEST(CsvLog, refuses_a_unit_that_is_none_of_a_gyros)
{
    const std::string text = rows(20, "time_s,g0x [rpm],g0y [rpm],g0z [rpm]");
    EXPECT_THAT(refusal_of(text), AllOf(HasSubstr("'rpm'"), HasSubstr("--unit")));
    expect_the_rows(samples_of(text, {RateUnit::deg_s, {}, {}}), 20, "g0");
    EXPECT_THAT(refusal_of("time_s,gx [deg/s],gy [rev/min],gz [deg/s]" + rows(20, "")), HasSubstr("'rev/min'"));
}

TEST(CsvLog, reads_the_units_below_the_names_also_beside_columns_with_units_of_other_things)
{
    const Samples log = samples_of(std::string("time,gx,gy,gz,temperature,mx\nms,deg/s,deg/s,deg/s,°C,uT\n0,1,2,3,20,40\n10,1,2,3,20,40\n"));
    ASSERT_EQ(log.samples.size(), 2U);
    EXPECT_EQ(log.samples[1].time_ns - log.samples[0].time_ns, 10'000'000);
    EXPECT_NEAR(log.samples[0].rate_rad_s[2] / degree, 3, 1e-9);
    const Samples gyro_alone = samples_of(std::string("time_ms,gx,gy,gz\n,deg/s,deg/s,deg/s\n0,1,2,3\n10,1,2,3\n"));
    ASSERT_EQ(gyro_alone.samples.size(), 2U);
    EXPECT_NEAR(gyro_alone.samples[0].rate_rad_s[2] / degree, 3, 1e-9);
}

TEST(CsvLog, reads_points_between_thousands_where_commas_are_decimal)
{
    const Samples log =
        samples_of(std::string("t (ms);gx (deg/s);gy (deg/s);gz (deg/s)\n990;0,5;1.000,5;2\n1.000;0,5;1,5;-1.234\n1.010;0,5;1,5;2,5\n"));
    ASSERT_EQ(log.samples.size(), 3U);
    EXPECT_EQ(log.samples[1].time_ns, 1'000'000'000);
    EXPECT_NEAR(log.samples[0].rate_rad_s[1] / degree, 1000.5, 1e-9);
    EXPECT_NEAR(log.samples[1].rate_rad_s[2] / degree, -1234, 1e-9);
    const Samples decimal = samples_of(std::string("t (s);gx (deg/s);gy (deg/s);gz (deg/s)\n1.000;0,5;123.456;0.010\n1.010;0,5;-123.456;0.123\n"));
    ASSERT_EQ(decimal.samples.size(), 2U);
    EXPECT_NEAR(decimal.samples[0].rate_rad_s[2] / degree, 0.010, 1e-9) << "points are decimal in the whole table where one cell shows it";
    EXPECT_NEAR(decimal.samples[0].rate_rad_s[1] / degree, 123.456, 1e-9);
    EXPECT_NEAR(decimal.samples[1].rate_rad_s[1] / degree, -123.456, 1e-9);
    const Samples negative = samples_of(std::string("t (ms);gx (deg/s);gy (deg/s);gz (deg/s)\n990;0,5;-123.456,5;2\n1.000;0,5;123.456;2\n"));
    ASSERT_EQ(negative.samples.size(), 2U);
    EXPECT_NEAR(negative.samples[0].rate_rad_s[1] / degree, -123456.5, 1e-9);
    EXPECT_NEAR(negative.samples[1].rate_rad_s[1] / degree, 123456, 1e-9);
    const Samples points = samples_of(std::string("t (s);gx_dps;gy_dps;gz_dps\n1.000;1;2;3\n1.010;1;2;3\n"));
    ASSERT_EQ(points.samples.size(), 2U);
    EXPECT_EQ(points.samples[1].time_ns, 1'010'000'000) << "without a decimal comma a point is a decimal one";
}

TEST(CsvLog, goes_on_over_midnight_with_times_of_day)
{
    const Samples log = samples_of(std::string("date,time,gx_dps,gy_dps,gz_dps\n2026-05-01,23:59:59.980,1,2,3\n2026-05-01,23:59:59.990,1,2,3\n"
                                               "2026-05-02,00:00:00.000,1,2,3\n2026-05-02,00:00:00.010,1,2,3\n"));
    ASSERT_EQ(log.samples.size(), 4U);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(log.samples[i].time_ns - log.samples[i - 1].time_ns, 10'000'000) << i;
}

TEST(CsvLog, counts_texts_for_no_value_as_missing)
{
    for (const std::string missing : {"", "NaN", "nan", "-nan", "null", "#N/A", "1.#QNAN", "--"}) {
        SCOPED_TRACE(missing);
        const Samples log = samples_of("t_s,gx_dps,gy_dps,gz_dps\n1.00,1,2,3\n1.01,1," + missing + ",3\n1.02,1,2,3\n");
        ASSERT_EQ(log.samples.size(), 3U);
        EXPECT_TRUE(std::isnan(log.samples[1].rate_rad_s[1]));
    }
}

TEST(CsvLog, says_where_the_user_contradicts_the_header)
{
    const Samples log = samples_of(rows(20, "time_s,gx [deg/s],gy [deg/s],gz [deg/s]"), {RateUnit::rad_s, {}, {}});
    EXPECT_THAT(log.remarks, Contains(HasSubstr("another unit")));
}

TEST(CsvLog, reads_instruments_whose_columns_name_no_quantity_where_no_other_column_does)
{
    const auto two_triads = [](const std::string& names) {
        std::string text = "time_s," + names + "\n";
        for (int i = 0; i < 20; ++i) text += std::to_string(1 + 0.01 * i) + ",1,2,3,4,5," + std::to_string(i) + "\n";
        return text;
    };
    const LogOptions deg_s{RateUnit::deg_s, {}, {}};
    const Samples bare = samples_of(two_triads("imu1_x,imu1_y,imu1_z,imu2_x,imu2_y,imu2_z"), deg_s);
    EXPECT_THAT(bare.names(), ElementsAre("imu1", "imu2"));
    ASSERT_EQ(bare.of("imu2").size(), 20U);
    EXPECT_NEAR(bare.of("imu2")[7].rate_rad_s[2], 7 * degree, 1e-12);
    EXPECT_THAT(samples_of(two_triads("imu1_gx,imu1_gy,imu1_gz,imu2_gx,imu2_gy,imu2_gz"), deg_s).names(), ElementsAre("imu1", "imu2"));
    EXPECT_THAT(samples_of(rows(20, "time_s,Sensor 3 X [deg/s],Sensor 3 Y [deg/s],Sensor 3 Z [deg/s]")).names(), ElementsAre("Sensor 3"));

    EXPECT_THAT(samples_of(two_triads("g0x_dps,g0y_dps,g0z_dps,imu1_x,imu1_y,imu1_z")).names(), ElementsAre("g0"))
        << "where gyros are named, other columns are something else";
    EXPECT_THAT(refusal_of(rows(20, "time_s,imu1_x [m],imu1_y [m],imu1_z [m]")), HasSubstr("time_s,g0x")) << "a place is no rate";
    EXPECT_THAT(refusal_of(rows(20, "time_s,target1_x,target1_y,target1_z")), HasSubstr("time_s,g0x"));
}

TEST(CsvLog, says_what_a_header_must_name)
{
    EXPECT_THAT(refusal_of("1,2,3,4\n5,6,7,8\n"), AllOf(HasSubstr("log.csv:1:"), HasSubstr("time_s,g0x")));
    EXPECT_THAT(refusal_of("gx_dps,gy_dps,gz_dps,u\n1,2,3,4\n"), HasSubstr("none of a time"));
    EXPECT_THAT(refusal_of("t_s,gx_dps,gy_dps,gz_dps\n1,1,2,3\n1,1,2,3\n"), HasSubstr("one after the other"));
}

}  // namespace
}  // namespace quorient::recording
