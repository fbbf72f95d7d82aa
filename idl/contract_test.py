#!/usr/bin/env python3
"""The documents agree with the IDL, and a disagreement of any kind is found."""
import unittest

import contract


class Contract(unittest.TestCase):
    def test_documents_are_what_the_idl_says(self):
        self.assertEqual(list(contract.problems()), [])


class Disagreement(unittest.TestCase):
    """The checks can fail: each on a small contract with one mistake."""

    CODES = {"SensorKind": [("gyro", 1)]}

    def struct(self, members):
        text = "// What it is.\n@final struct Sample {\n" + members + "\n};\n"
        return contract.parse_idl(text)[0]

    def test_a_member_without_its_unit(self):
        found = list(contract.comment_problems(self.struct("double rate;  // rate of turn"), self.CODES))
        self.assertRegex(found[0], "rate.*unit")

    def test_a_code_that_does_not_exist(self):
        found = list(contract.comment_problems(self.struct("octet kind;  // SensorSort"), self.CODES))
        self.assertRegex(found[0], "SensorSort")

    def test_hidden_padding(self):
        found = list(contract.layout_problems(self.struct("unsigned long a;  // count\ndouble b;  // [s] x")))
        self.assertRegex(found[0], "hidden padding")

    def test_a_string(self):
        with self.assertRaises(SystemExit):
            self.struct("string name;  // unbounded")

    def test_a_sample_with_another_field(self):
        struct = self.struct("octet kind;  // SensorKind")
        self.assertTrue(list(contract.sample_problems("x", struct, "sort: 1")))
        self.assertTrue(list(contract.sample_problems("x", struct, "kind: 256")))
        self.assertTrue(list(contract.sample_problems("x", struct, "kind: [1]")))
        self.assertEqual(list(contract.sample_problems("x", struct, "kind: 1")), [])

    def test_a_sample_with_another_length(self):
        struct = self.struct("double axis[2][3];  // [1] unit vectors")
        self.assertEqual(list(contract.sample_problems("x", struct, "axis: [[1,0,0],[0,1,0]]")), [])
        self.assertTrue(list(contract.sample_problems("x", struct, "axis: [[1,0,0],[0,1]]")))


if __name__ == "__main__":
    unittest.main(verbosity=2)
