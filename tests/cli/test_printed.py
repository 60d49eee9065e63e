"""Tables as they are printed."""

import numpy as np
import pandas as pd

from kinetostatics.cli.printed import print_table


def test_a_zero_is_printed_without_a_sign(capsys):
    print_table(pd.DataFrame({"smallest": [-0.0, -1e-20, -2.5, np.nan], "unit": "N"}, index=list("abcd")))
    assert [line.split()[1] for line in capsys.readouterr().out.splitlines()[2:]] == ["0", "-1e-20", "-2.5", "N"]
