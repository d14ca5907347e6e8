"""SQL by DuckDB's library, through its C interface."""
import ctypes
from pathlib import Path

LIBRARY = Path(__file__).parent / "node_modules" / "@duckdb" / "node-bindings-linux-x64" / "libduckdb.so"


class QueryResult(ctypes.Structure):
    # duckdb_result of duckdb.h
    _fields_ = [("columns", ctypes.c_uint64), ("rows", ctypes.c_uint64), ("changed", ctypes.c_uint64),
                ("column_data", ctypes.c_void_p), ("error", ctypes.c_char_p), ("internal", ctypes.c_void_p)]


def query(sql: str) -> list:
    """The rows, a dictionary of texts by column each; None where there is no value."""
    duckdb = ctypes.CDLL(str(LIBRARY))
    for name in ("duckdb_result_error", "duckdb_column_name"):
        getattr(duckdb, name).restype = ctypes.c_char_p
    duckdb.duckdb_value_varchar.restype = ctypes.c_void_p
    for name in ("duckdb_column_count", "duckdb_row_count"):
        getattr(duckdb, name).restype = ctypes.c_uint64
    database, connection, result = ctypes.c_void_p(), ctypes.c_void_p(), QueryResult()
    at = ctypes.byref(result)
    if duckdb.duckdb_open(None, ctypes.byref(database)) or duckdb.duckdb_connect(database, ctypes.byref(connection)):
        raise RuntimeError("DuckDB opens no database")
    try:
        if duckdb.duckdb_query(connection, sql.encode(), at):
            raise RuntimeError(duckdb.duckdb_result_error(at).decode())
        names = [duckdb.duckdb_column_name(at, ctypes.c_uint64(k)).decode() for k in range(duckdb.duckdb_column_count(at))]
        return [{name: text_at(duckdb, at, column, row) for column, name in enumerate(names)} for row in range(duckdb.duckdb_row_count(at))]
    finally:
        duckdb.duckdb_destroy_result(at)
        duckdb.duckdb_disconnect(ctypes.byref(connection))
        duckdb.duckdb_close(ctypes.byref(database))


def text_at(duckdb, at, column, row):
    place = duckdb.duckdb_value_varchar(at, ctypes.c_uint64(column), ctypes.c_uint64(row))
    if not place:
        return None
    text = ctypes.string_at(place).decode()
    duckdb.duckdb_free(ctypes.c_void_p(place))
    return text
